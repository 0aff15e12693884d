//! The times of the rows of tables.

use rdsolve::model::{Cadence, StepLength, round_up};

#[test]
fn steps_between_rows_are_round_numbers() {
    for (number, round) in [(0.01, 1), (1.0, 1), (1.0 + 1e-12, 1), (1.1, 2), (2.1, 5), (5.1, 10), (1999.0, 2000)] {
        assert_eq!(round_up(number), round, "{number}");
    }
    let fixed = StepLength::Fixed { step: 1e-4 };
    assert_eq!(Cadence::at_most(1000.0, 0.1, &fixed), Cadence::Steps(1));
    assert_eq!(Cadence::at_most(1000.0, 0.3, &fixed), Cadence::Steps(5));
    let automatic = StepLength::StabilityLimited { fraction: 0.8 };
    assert_eq!(Cadence::at_most(1000.0, 0.5, &automatic), Cadence::Apart(5e-4));
}
