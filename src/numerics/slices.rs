//! Slices whose length the compiler does not know: those of the caller and of workspaces.
//!
//! Every index is inside. The compiler cannot prove it, and `[i]` would compile to a panic, which the library must not
//! contain. Here a value outside is 0, is not stored, and a part that reaches outside is empty. Arrays of a known
//! length keep `[i]`.

use super::lanes::Lanes;
use core::slice::SliceIndex;

/// Types with a value 0, which is read outside of a slice.
pub(crate) trait Zero: Copy {
    fn zero() -> Self;
}

impl Zero for f64 {
    fn zero() -> f64 {
        0.0
    }
}

impl Zero for u64 {
    fn zero() -> u64 {
        0
    }
}

impl<const L: usize> Zero for Lanes<L> {
    fn zero() -> Self {
        Lanes::ZERO
    }
}

impl<T: Zero, const N: usize> Zero for [T; N] {
    fn zero() -> [T; N] {
        [T::zero(); N]
    }
}

/// Access to a slice that cannot panic.
pub(crate) trait PanicFreeSlice<T> {
    /// The value at an index; 0 beyond the end.
    fn or_zero(&self, index: usize) -> T;

    /// Stores a value at an index; whether it is inside.
    fn set(&mut self, index: usize, value: T) -> bool;

    /// The values of a range.
    fn part<R: SliceIndex<[T], Output = [T]>>(&self, range: R) -> &[T];
    fn part_mut<R: SliceIndex<[T], Output = [T]>>(&mut self, range: R) -> &mut [T];

    /// Copies the values that both have.
    fn copy_from(&mut self, source: &[T]);

    /// Blocks of K values, without those that do not fill one.
    fn blocks<const K: usize>(&self) -> &[[T; K]];
    fn blocks_mut<const K: usize>(&mut self) -> &mut [[T; K]];
}

impl<T: Zero> PanicFreeSlice<T> for [T] {
    fn or_zero(&self, index: usize) -> T {
        match self.get(index) {
            Some(value) => *value,
            None => T::zero(),
        }
    }

    fn set(&mut self, index: usize, value: T) -> bool {
        match self.get_mut(index) {
            Some(place) => {
                *place = value;
                true
            }
            None => false,
        }
    }

    fn part<R: SliceIndex<[T], Output = [T]>>(&self, range: R) -> &[T] {
        self.get(range).unwrap_or_default()
    }

    fn part_mut<R: SliceIndex<[T], Output = [T]>>(&mut self, range: R) -> &mut [T] {
        self.get_mut(range).unwrap_or_default()
    }

    fn copy_from(&mut self, source: &[T]) {
        self.iter_mut().zip(source).for_each(|(place, value)| *place = *value);
    }

    fn blocks<const K: usize>(&self) -> &[[T; K]] {
        self.as_chunks().0
    }

    fn blocks_mut<const K: usize>(&mut self) -> &mut [[T; K]] {
        self.as_chunks_mut().0
    }
}

/// A stack in a slice: what does not fit is lost.
pub(crate) struct Stack<'a, T> {
    pub values: &'a mut [T],
    pub depth: usize,
}

impl<T: Zero> Stack<'_, T> {
    pub fn push(&mut self, value: T) {
        self.depth += usize::from(self.values.set(self.depth, value));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outside_is_zero_and_not_stored() {
        let mut values = [1.0, 2.0];
        let values = values.as_mut_slice();
        assert_eq!([values.or_zero(1), values.or_zero(2), values.or_zero(usize::MAX)], [2.0, 0.0, 0.0]);
        assert!(values.set(0, 3.0) && !values.set(2, 4.0));
        assert_eq!((values.part(..1), values.part(1..3)), ([3.0].as_slice(), [].as_slice()));
        let mut stack = Stack { values, depth: 1 };
        stack.push(5.0);
        stack.push(6.0);
        assert_eq!((stack.depth, stack.values.or_zero(1)), (2, 5.0));
    }
}
