//! The program from outside: arguments in, exit codes out.

mod accuracy;
mod around_a_run;
mod check_numbers;
mod cli;
mod ends;
mod foreign_input;
mod instructions;
mod memory_forecast;
mod resume;
mod signals;
mod strange_input;
