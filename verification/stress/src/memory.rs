//! The displacements of a history that are not wiped out, by definition instead of by a stack.

use reference::history::reversals;

/// A displacement of the history, and the force of the library there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    pub displacement: f64,
    pub force: f64,
}

/// The points that are not wiped out, oldest first; the last is the present one, the others are reversals.
#[derive(Debug, Clone)]
pub struct Memory {
    slip: f64,
    /// Direction of the last gross slip, 0 if there was none. The oldest point is then where it ended.
    pub slip_direction: f64,
    pub points: Vec<Point>,
    /// The point before, if the last step returned to it: the same displacement, or its opposite on the initial loading curve.
    pub returned: Option<Point>,
}

impl Memory {
    pub fn new(slip: f64) -> Memory {
        Memory { slip, slip_direction: 0.0, points: vec![Point { displacement: 0.0, force: 0.0 }], returned: None }
    }

    pub fn now(&self) -> Point {
        self.points[self.points.len() - 1]
    }

    pub fn depth(&self) -> usize {
        self.points.len() - 1
    }

    /// Whether a displacement leads to gross slip; `None` if that depends on rounding.
    fn slips(&self, displacement: f64) -> Option<bool> {
        let first = self.points[0].displacement;
        if self.slip_direction == 0.0 {
            return Some(displacement.abs() > self.slip);
        }
        if self.slip_direction * (displacement - first) >= 0.0 {
            return Some(true);
        }
        // In the other direction twice the displacement of gross slip; the library rounds where that ends.
        let distance = (displacement - first).abs();
        let rounding = 2.0 * f64::EPSILON * (first.abs() + displacement.abs() + self.slip);
        if (distance - 2.0 * self.slip).abs() <= rounding { None } else { Some(distance > 2.0 * self.slip) }
    }

    /// Advances to a displacement; `slips` is used if it depends on rounding.
    pub fn visit(&mut self, point: Point, slips: bool) {
        let displacement = point.displacement;
        self.returned = None;
        if self.slips(displacement).unwrap_or(slips) {
            let ahead = self.slip_direction * (displacement - self.points[0].displacement) >= 0.0;
            self.slip_direction = match self.slip_direction {
                0.0 => displacement.signum(),
                direction if ahead => direction,
                direction => -direction,
            };
            self.points = vec![point];
            return;
        }
        let first = self.points[0];
        self.points.push(point);
        let displacements: Vec<f64> = self.points.iter().map(|point| point.displacement).collect();
        let kept = reversals(&displacements, self.slip_direction).len();
        // A point that was wiped out may have the displacement of the new one.
        let wiped = self.points[kept - 1..self.points.len() - 1].iter().rev();
        self.returned = wiped.into_iter().find(|old| old.displacement == displacement).copied().or_else(|| {
            let mirrored = self.slip_direction == 0.0 && kept == 1 && displacement == -first.displacement;
            mirrored.then_some(Point { displacement, force: -first.force })
        });
        self.points.truncate(kept - 1);
        self.points.push(point);
    }

    /// A path from the unloaded state with the same memory and no others.
    pub fn shortest_path(&self) -> Vec<f64> {
        let first = self.points[0].displacement;
        // From so far that the contact slips all the way to the end of its gross slip.
        let run_up =
            (self.slip_direction != 0.0).then(|| first - self.slip_direction * (4.0 * self.slip + first.abs()));
        run_up.into_iter().chain(self.points.iter().map(|point| point.displacement)).collect()
    }
}
