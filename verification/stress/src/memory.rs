//! The memory of a contact by definition instead of by a stack: of all displacements since the last gross slip the one farthest
//! from the origin, after it the farthest in the other direction, after that the farthest in the first direction again, and so on to
//! the present one; of equal ones the last. Everything else is wiped out. All but the present one are reversals.

/// A displacement that was visited, and the force that was answered there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    pub displacement: f64,
    pub force: f64,
}

/// The points of a history that were not wiped out, oldest first; the last is the present one.
#[derive(Debug, Clone)]
pub struct Memory {
    slip: f64,
    /// Direction of the last gross slip, 0 if there was none. The oldest point is then where it ended.
    pub slip_direction: f64,
    pub points: Vec<Point>,
    /// The point that was visited before, if the last step led back to it: the same displacement, or its opposite on the
    /// initial loading curve.
    pub returned: Option<Point>,
}

impl Memory {
    pub fn new(slip: f64) -> Memory {
        Memory { slip, slip_direction: 0.0, points: vec![Point { displacement: 0.0, force: 0.0 }], returned: None }
    }

    pub fn now(&self) -> Point {
        *self.points.last().expect("the present point is always there")
    }

    pub fn depth(&self) -> usize {
        self.points.len() - 1
    }

    /// Whether a displacement leads to gross slip; `None` if rounding decides.
    pub fn slips(&self, displacement: f64) -> Option<bool> {
        let first = self.points[0].displacement;
        if self.slip_direction == 0.0 {
            return Some(displacement.abs() > self.slip);
        }
        if self.slip_direction * (displacement - first) >= 0.0 {
            return Some(true);
        }
        // Back by twice the way of the monotonic curve; the other end is rounded where it is remembered.
        let way = (displacement - first).abs();
        let rounding = 2.0 * f64::EPSILON * (first.abs() + displacement.abs() + self.slip);
        if (way - 2.0 * self.slip).abs() <= rounding { None } else { Some(way > 2.0 * self.slip) }
    }

    /// Advances to a displacement; `slips` decides if rounding does.
    pub fn visit(&mut self, point: Point, slips: bool) {
        let displacement = point.displacement;
        self.returned = None;
        if self.slips(displacement).unwrap_or(slips) {
            let ahead = self.slip_direction * (displacement - self.points[0].displacement) >= 0.0;
            self.slip_direction = if self.slip_direction == 0.0 {
                displacement.signum()
            } else if ahead {
                self.slip_direction
            } else {
                -self.slip_direction
            };
            self.points.clear();
            self.points.push(point);
            return;
        }
        let amplitude = self.points[0].displacement.abs();
        self.points.push(point);
        let left = essence(self.slip_direction, &self.points);
        // What was wiped out beside the new point may be the very displacement that it has now.
        let wiped = &self.points[left.len() - 1..self.points.len() - 1];
        self.returned = wiped.iter().rev().find(|old| old.displacement == displacement).copied().or_else(|| {
            let mirrored = self.slip_direction == 0.0 && left.len() == 1 && displacement.abs() == amplitude;
            mirrored.then(|| {
                let old = self.points[0];
                Point { displacement: -old.displacement, force: -old.force }
            })
        });
        self.points = left;
    }

    /// A path from the unloaded state that leaves nothing else than this memory.
    pub fn shortest_path(&self) -> Vec<f64> {
        let first = self.points[0].displacement;
        // To the end of a slip from so far that the whole way there ends in slip.
        let run_up =
            (self.slip_direction != 0.0).then(|| first - self.slip_direction * (4.0 * self.slip + first.abs()));
        run_up.into_iter().chain(self.points.iter().map(|point| point.displacement)).collect()
    }
}

/// The definition itself, on all points of a history since its last gross slip.
fn essence(slip_direction: f64, all: &[Point]) -> Vec<Point> {
    // The last of the largest from each place on, of the displacement times `sign`.
    let largest_from = |sign: f64| {
        let mut places: Vec<usize> = (0..all.len()).collect();
        for place in (0..all.len() - 1).rev() {
            let after = places[place + 1];
            if sign * all[after].displacement >= sign * all[place].displacement {
                places[place] = after;
            }
        }
        places
    };
    let (highest, lowest) = (largest_from(1.0), largest_from(-1.0));
    let (high, low) = (all[highest[0]].displacement, all[lowest[0]].displacement);
    // Since a slip nothing was beyond its end; before any, either side may be the farther one.
    let mut upwards = match (slip_direction, high + low) {
        (0.0, 0.0) => highest[0] > lowest[0],
        (0.0, sum) => sum > 0.0,
        _ => slip_direction > 0.0,
    };
    let mut place = if upwards { highest[0] } else { lowest[0] };
    let mut left = vec![all[place]];
    while place + 1 < all.len() {
        upwards = !upwards;
        place = if upwards { highest[place + 1] } else { lowest[place + 1] };
        left.push(all[place]);
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Wiped out at once or at the end, the same is left: small whole numbers, so that everything returns often.
    #[test]
    fn wiping_out_step_by_step_is_wiping_out_at_the_end() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut deepest = 0;
        for _ in 0..3000 {
            let mut memory = Memory::new(1e3);
            let mut all = memory.points.clone();
            for _ in 0..rng.random_range(1..40) {
                let width = rng.random_range(1..=9);
                let displacement = f64::from(rng.random_range(-width..=width));
                let point = Point { displacement, force: rng.random() };
                memory.visit(point, false);
                all.push(point);
                assert_eq!(memory.points, essence(0.0, &all), "{all:?}");
            }
            deepest = deepest.max(memory.depth());
        }
        assert!(deepest > 5);
    }

    #[test]
    fn gross_slip_leaves_its_end_alone() {
        let mut memory = Memory::new(1.0);
        let mut go = |displacement: f64| {
            memory.visit(Point { displacement, force: 0.0 }, false);
            (memory.depth(), memory.slip_direction)
        };
        let steps = [0.5, -0.2, 1.0, 0.3, 1.5, 0.0, 0.2, 1.5, 1.4, -0.6, 1.3, 3.3];
        let depths = [0, 1, 0, 1, 0, 1, 2, 0, 1, 0, 1, 0];
        let slip_direction = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, -1.0, -1.0, 1.0];
        for ((displacement, depth), slip_direction) in steps.into_iter().zip(depths).zip(slip_direction) {
            assert_eq!(go(displacement), (depth, slip_direction), "{displacement}");
        }
    }
}
