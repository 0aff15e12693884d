//! Objects that each thread needs one of while it works; fewer than tasks.

use std::sync::{Condvar, Mutex, PoisonError};

/// Things to be borrowed by one task at a time.
pub(super) struct LendingPool<T> {
    free: Mutex<Vec<T>>,
    returned: Condvar,
}

impl<T> LendingPool<T> {
    pub fn new(things: impl Iterator<Item = T>) -> LendingPool<T> {
        LendingPool { free: Mutex::new(things.collect()), returned: Condvar::new() }
    }

    /// Runs a task with one of the things. Where all are taken it waits, so tasks must not wait for each other.
    pub fn with<R>(&self, task: impl FnOnce(&mut T) -> R) -> R {
        let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        let mut thing = loop {
            match free.pop() {
                Some(thing) => break thing,
                None => free = self.returned.wait(free).unwrap_or_else(PoisonError::into_inner),
            }
        };
        drop(free);
        let result = task(&mut thing);
        self.free.lock().unwrap_or_else(PoisonError::into_inner).push(thing);
        self.returned.notify_one();
        result
    }

    /// Visits all objects; none may be borrowed.
    pub fn each(&mut self, visit: impl FnMut(&mut T)) {
        self.free.get_mut().unwrap_or_else(PoisonError::into_inner).iter_mut().for_each(visit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_tasks_than_things_take_turns() {
        let pool = LendingPool::new([0, 0].into_iter());
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| (0..100).for_each(|_| pool.with(|count| *count += 1)));
            }
        });
        assert_eq!(pool.free.into_inner().unwrap().iter().sum::<i32>(), 800);
    }
}
