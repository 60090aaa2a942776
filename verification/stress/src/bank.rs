//! A bank of spring-sliders in parallel (Jenkins, Iwan). Its load history is the elongation of each spring, without Masing's rule.

use reference::Reference;

/// Sums that the processor may add side by side.
const LANES: usize = 8;

/// A point of the monotonic curve.
#[derive(Debug, Clone, Copy)]
pub struct CurvePoint {
    pub displacement: f64,
    pub force: f64,
}

/// Points of the exact curve from the unloaded state to gross slip. Stick zones shrink like a cosine, so that steps are small where
/// the compliance of a short contact grows from almost nothing; the last point is gross slip.
pub fn curve(contact: &Reference, pieces: usize) -> Vec<CurvePoint> {
    let law = contact.law(0);
    let w = law.w_range();
    let points = (0..=pieces).map(|k| match k {
        0 => law.at_w(&w),
        k if k == pieces => law.slip_point(),
        k => law.at_w(&(&w * (0.5 * std::f64::consts::PI * (1.0 - k as f64 / pieces as f64)).sin())),
    });
    points
        .map(|point| CurvePoint {
            displacement: (&law.displacement_unit * point.x).f64(),
            force: (&law.slip_force * point.tau).f64(),
        })
        .collect()
}

pub struct Bank {
    stiffness: Vec<f64>,
    /// Elongation at which each one slips.
    slip: Vec<f64>,
    elongation: Vec<f64>,
    displacement: f64,
}

impl Bank {
    /// The bank whose curve is the polygon through these points, the first of them the origin: one slider slips at each corner
    /// and has the change of slope there as its stiffness.
    pub fn polygon(corners: &[CurvePoint]) -> Bank {
        let slopes: Vec<f64> = corners
            .windows(2)
            .map(|side| (side[1].force - side[0].force) / (side[1].displacement - side[0].displacement))
            .collect();
        let next = slopes.iter().skip(1).chain([&0.0]);
        let mut stiffness: Vec<f64> = slopes.iter().zip(next).map(|(slope, next)| slope - next).collect();
        let mut slip: Vec<f64> = corners[1..].iter().map(|corner| corner.displacement).collect();
        let whole = stiffness.len().next_multiple_of(LANES);
        stiffness.resize(whole, 0.0);
        slip.resize(whole, 0.0);
        Bank { elongation: vec![0.0; whole], stiffness, slip, displacement: 0.0 }
    }

    /// Advances to a displacement: force, and energy dissipated.
    pub fn step(&mut self, displacement: f64) -> (f64, f64) {
        let way = displacement - self.displacement;
        self.displacement = displacement;
        let (mut force, mut energy) = ([0.0; LANES], [0.0; LANES]);
        let springs = self.stiffness.as_chunks::<LANES>().0.iter().zip(self.slip.as_chunks::<LANES>().0);
        for (elongation, (stiffness, slip)) in self.elongation.as_chunks_mut::<LANES>().0.iter_mut().zip(springs) {
            for i in 0..LANES {
                let free = elongation[i] + way;
                elongation[i] = free.max(-slip[i]).min(slip[i]);
                force[i] += stiffness[i] * elongation[i];
                energy[i] += stiffness[i] * slip[i] * (free - elongation[i]).abs();
            }
        }
        (force.iter().sum(), energy.iter().sum())
    }
}

/// Largest distance in force of the polygon through every `each`-th of these points from the others: the largest error of the
/// monotonic curve of a bank.
pub fn polygon_error(curve: &[CurvePoint], each: usize) -> f64 {
    let sides = (0..curve.len() - 1).step_by(each).map(|first| &curve[first..=first + each]);
    sides
        .flat_map(|side| {
            let (from, to) = (side[0], side[each]);
            let slope = (to.force - from.force) / (to.displacement - from.displacement);
            side.iter().map(move |point| point.force - from.force - slope * (point.displacement - from.displacement))
        })
        .fold(0.0, |worst, error| error.abs().max(worst))
}
