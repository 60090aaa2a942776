//! A bank of spring-sliders in parallel (Jenkins, Iwan) with the monotonic curve of a contact: its memory is the elongation of
//! each spring, and no rule of Masing's is used. It is made of the curve by itself, not by the library.

use crate::family::CurvePoint;

/// Sums that the processor may add up side by side.
const LANES: usize = 8;

pub struct Bank {
    stiffness: Vec<f64>,
    /// Elongation at which each one slips.
    slip: Vec<f64>,
    elongation: Vec<f64>,
    displacement: f64,
}

impl Bank {
    /// The bank whose curve is the polygon through these points, the first of them the origin: at each corner one slider gives
    /// way, and takes with it the change of slope.
    pub fn polygon(corners: &[CurvePoint]) -> Bank {
        let slopes: Vec<f64> = corners
            .windows(2)
            .map(|side| (side[1].force - side[0].force) / (side[1].displacement - side[0].displacement))
            .collect();
        let next = slopes.iter().skip(1).chain([&0.0]);
        let sliders =
            slopes.iter().zip(next).zip(&corners[1..]).map(|((slope, next), end)| (slope - next, end.displacement));
        Bank::of(sliders.collect())
    }

    /// Stiffness and slip elongation of each slider.
    pub fn of(sliders: Vec<(f64, f64)>) -> Bank {
        let (mut stiffness, mut slip): (Vec<f64>, Vec<f64>) = sliders.into_iter().unzip();
        // Sliders that do nothing make whole lanes of them.
        let whole = stiffness.len().next_multiple_of(LANES);
        stiffness.resize(whole, 0.0);
        slip.resize(whole, 0.0);
        Bank { elongation: vec![0.0; whole], stiffness, slip, displacement: 0.0 }
    }

    /// Leads the bank to a displacement: force, and energy dissipated on the way.
    pub fn step(&mut self, displacement: f64) -> (f64, f64) {
        let way = displacement - self.displacement;
        self.displacement = displacement;
        let (mut force, mut energy) = ([0.0; LANES], [0.0; LANES]);
        let springs = self.stiffness.as_chunks::<LANES>().0.iter().zip(self.slip.as_chunks::<LANES>().0);
        for (elongation, (stiffness, slip)) in self.elongation.as_chunks_mut::<LANES>().0.iter_mut().zip(springs) {
            for i in 0..LANES {
                let wanted = elongation[i] + way;
                elongation[i] = wanted.max(-slip[i]).min(slip[i]);
                force[i] += stiffness[i] * elongation[i];
                energy[i] += stiffness[i] * slip[i] * (wanted - elongation[i]).abs();
            }
        }
        (force.iter().sum(), energy.iter().sum())
    }
}

/// How far the polygon through every `each`-th of these points lies from the others, in force: the largest error of a bank's
/// monotonic curve.
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
