//! Harmonic force by alternating between frequency and time, with its exact Jacobian.
//!
//! The displacement `c0 + Σ (a_k cos kt + b_k sin kt)` is sampled at equidistant instants, the contact is led twice through
//! the period from the virgin state, and the second period's forces are transformed back.
//!
//! The Jacobian follows the memory exactly. On a branch from a reversal r, `T = T_r ± 2 M⁻¹(|δ-δ_r|/2)`, so that with the
//! tangent stiffness k of the branch
//!
//! ```text
//! dT = k (dδ - dδ_r) + dT_r,
//! ```
//!
//! where `dδ_r` belongs to the sample of the reversal, and `dT_r` was known when the reversal was passed. Each remembered
//! reversal keeps its `dT_r` as a row over the harmonic coefficients.

use crate::contact::Contact;
use crate::curve::{Response, check_displacement};
use crate::error::Error;
use crate::masing::{self, Dissipation};
use crate::memory::{self, Course, Reversal, State, Virgin};
use core::f64::consts::PI;

/// Tells a workspace from other memory.
const MARK: f64 = f64::from_bits(0x4d53_4c49_5057_5331);

const HEADER: usize = 3;

/// Numbers of doubles in the parts of a workspace.
struct Layout {
    /// 2H + 1 coefficients.
    coefficients: usize,
    samples: usize,
}

impl Layout {
    fn new(harmonics: usize, samples: usize) -> Result<Layout, Error> {
        // Far beyond any use.
        const LARGEST: usize = 1 << 24;
        if !(1..=LARGEST).contains(&harmonics) {
            return Err(Error::BadHarmonics);
        }
        if samples <= 2 * harmonics || samples > LARGEST {
            return Err(Error::BadSamples);
        }
        let coefficients = 2 * harmonics + 1;
        // Four tables are more than a workspace holds: where addresses have 32 bits even that may be too much.
        if (samples + 8).checked_mul(4 * coefficients).is_none_or(|bytes| bytes > isize::MAX as usize / 8) {
            return Err(Error::BadSamples);
        }
        Ok(Layout { coefficients, samples })
    }

    /// A period nests at most as many reversals as it has samples.
    fn reversals(&self) -> usize {
        self.samples + 1
    }

    fn table(&self) -> usize {
        self.samples * self.coefficients
    }

    fn length(&self) -> usize {
        let gradients = self.reversals() * self.coefficients;
        HEADER + self.table() + self.samples + 2 * self.reversals() + self.reversals() + gradients + self.coefficients
    }
}

/// Doubles of a workspace for so many harmonics H and samples a period; 0 where there is none (H = 0, or too few samples).
#[must_use]
pub fn workspace_length(harmonics: usize, samples: usize) -> usize {
    Layout::new(harmonics, samples).map_or(0, |layout| layout.length())
}

/// Prepares a workspace: the tables of one pair of harmonics and samples, and scratch memory.
///
/// # Errors
/// `BadHarmonics` for none, `BadSamples` for samples <= 2H, `WorkspaceTooShort`.
pub fn workspace_init(harmonics: usize, samples: usize, workspace: &mut [f64]) -> Result<(), Error> {
    let layout = Layout::new(harmonics, samples)?;
    let Some(workspace) = workspace.get_mut(..layout.length()) else { return Err(Error::WorkspaceTooShort) };
    workspace.fill(0.0);
    if let [mark, h, n, rest @ ..] = workspace {
        (*mark, *h, *n) = (MARK, harmonics as f64, samples as f64);
        for (sample, row) in rest.chunks_exact_mut(layout.coefficients.max(1)).take(samples).enumerate() {
            for (k, value) in row.iter_mut().enumerate() {
                // The turn k sample/samples, reduced before it meets π.
                let turn = (k.div_ceil(2) * sample % samples) as f64 / samples as f64;
                *value = if k % 2 == 1 || k == 0 { (2.0 * PI * turn).cos() } else { (2.0 * PI * turn).sin() };
            }
        }
    }
    Ok(())
}

/// A workspace as it is used.
#[derive(Debug)]
pub struct Workspace<'a> {
    samples: usize,
    /// 2H + 1.
    coefficients: usize,
    /// One row a sample: 1, cos t, sin t, cos 2t, ...
    table: &'a [f64],
    displacement: &'a mut [f64],
    reversals: &'a mut [f64],
    /// Sample of each reversal.
    turned_at: &'a mut [f64],
    /// dT_r of each reversal, a row over the coefficients.
    gradients: &'a mut [f64],
    /// dT of the sample at hand.
    row: &'a mut [f64],
}

/// Doubles that a prepared workspace occupies, from its first three.
///
/// # Errors
/// `BadWorkspace` for memory that was not initialised, or was changed.
pub fn workspace_extent(header: &[f64; HEADER]) -> Result<usize, Error> {
    layout_of(header).map(|layout| layout.length())
}

fn layout_of(header: &[f64; HEADER]) -> Result<Layout, Error> {
    let &[mark, harmonics, samples] = header;
    // Compared as doubles: a conversion of what is no number would trap.
    let whole = |value: f64| (1.0..=16_777_216.0).contains(&value) && value.floor() == value;
    if mark.to_bits() != MARK.to_bits() || !whole(harmonics) || !whole(samples) {
        return Err(Error::BadWorkspace);
    }
    Layout::new(harmonics as usize, samples as usize).map_err(|_| Error::BadWorkspace)
}

impl<'a> Workspace<'a> {
    /// Takes a prepared workspace into use.
    ///
    /// # Errors
    /// `BadWorkspace` for memory that was not initialised, or was changed.
    pub fn new(workspace: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let layout = layout_of(workspace.first_chunk::<HEADER>().ok_or(Error::BadWorkspace)?)?;
        let rest = workspace.get_mut(HEADER..layout.length()).ok_or(Error::BadWorkspace)?;
        let mut parts = Parts(rest);
        let table = parts.take(layout.table())?;
        Ok(Workspace {
            samples: layout.samples,
            coefficients: layout.coefficients,
            table,
            displacement: parts.take(layout.samples)?,
            reversals: parts.take(2 * layout.reversals())?,
            turned_at: parts.take(layout.reversals())?,
            gradients: parts.take(layout.reversals() * layout.coefficients)?,
            row: parts.take(layout.coefficients)?,
        })
    }

    /// 2H + 1.
    #[must_use]
    pub fn coefficients(&self) -> usize {
        self.coefficients
    }

    /// Row of a sample: 1, cos t, sin t, cos 2t, ...
    fn table_row(&self, sample: usize) -> &'a [f64] {
        self.table.chunks_exact(self.coefficients.max(1)).nth(sample).unwrap_or(&[])
    }
}

/// Divides a slice from its front.
struct Parts<'a>(&'a mut [f64]);

impl<'a> Parts<'a> {
    fn take(&mut self, length: usize) -> Result<&'a mut [f64], Error> {
        let (front, back) = core::mem::take(&mut self.0).split_at_mut_checked(length).ok_or(Error::BadWorkspace)?;
        self.0 = back;
        Ok(front)
    }
}

/// Where the coefficients of the force, its Jacobian (column-major) and the energy go; `None` is not computed.
#[derive(Debug)]
pub struct HarmonicOutput<'a> {
    /// 2H + 1 coefficients of the force \[N\].
    pub force: Option<&'a mut [f64]>,
    /// (2H + 1)² derivatives of force i by displacement j \[N/m\] at `i + (2H + 1) j`.
    pub jacobian: Option<&'a mut [f64]>,
    /// Energy dissipated per period \[J\].
    pub dissipated: Option<&'a mut f64>,
}

/// Refuses a coefficient that is no number, or too large.
///
/// # Errors
/// `BadDisplacement`.
pub fn check_coefficients(displacement: &[f64]) -> Result<(), Error> {
    displacement.iter().try_for_each(|&coefficient| check_displacement(coefficient))
}

/// Harmonic force of a periodic displacement given by its 2H + 1 coefficients \[m\].
///
/// # Errors
/// `BadDisplacement` for a coefficient that is not finite, `BadArraySize` where a length is not that of the workspace.
pub fn harmonic_force(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) -> Result<(), Error> {
    let n = workspace.coefficients.max(1);
    let HarmonicOutput { mut force, mut jacobian, dissipated } = output;
    let fits = |output: &Option<&mut [f64]>, length: usize| output.as_ref().is_none_or(|output| output.len() == length);
    if displacement.len() != n || !fits(&force, n) || !fits(&jacobian, n * n) {
        return Err(Error::BadArraySize);
    }
    check_coefficients(displacement)?;
    for output in [&mut force, &mut jacobian].into_iter().flatten() {
        output.fill(0.0);
    }
    let mut energy = dissipated.is_some().then(|| Dissipation::new(contact));
    if !contact.is_frictionless() {
        for (value, row) in workspace.displacement.iter_mut().zip(workspace.table.chunks_exact(n)) {
            *value = row.iter().zip(displacement).map(|(table, coefficient)| table * coefficient).sum();
        }
        let mut walk = Walk::new(contact, workspace, jacobian.is_some());
        for sample in 0..walk.workspace.samples {
            walk.advance(sample, &mut None);
        }
        for sample in 0..walk.workspace.samples {
            walk.advance(sample, &mut energy);
            let row = walk.workspace.table_row(sample);
            if let Some(force) = &mut force {
                let now = walk.force();
                force.iter_mut().zip(row).for_each(|(sum, table)| *sum += now * table);
            }
            if let Some(jacobian) = &mut jacobian {
                walk.differentiate();
                for (column, gradient) in jacobian.chunks_exact_mut(n).zip(walk.workspace.row.iter()) {
                    column.iter_mut().zip(row).for_each(|(sum, table)| *sum += gradient * table);
                }
            }
        }
        let samples = walk.workspace.samples as f64;
        for output in [&mut force, &mut jacobian].into_iter().flatten() {
            for (k, value) in output.iter_mut().enumerate() {
                *value *= if k % n == 0 { 1.0 / samples } else { 2.0 / samples };
            }
        }
    }
    if let (Some(dissipated), Some(energy)) = (dissipated, energy) {
        *dissipated = energy.total();
    }
    Ok(())
}

/// The walk through the samples: the memory, and the point at hand. Its force and its derivative are found when asked for.
struct Walk<'w, 'a> {
    contact: &'w Contact,
    workspace: &'w mut Workspace<'a>,
    with_gradients: bool,
    virgin: Virgin,
    depth: usize,
    sample: usize,
    displacement: f64,
    course: Course,
    /// Force and tangent stiffness of the point at hand.
    known: Option<(f64, f64)>,
}

impl<'w, 'a> Walk<'w, 'a> {
    fn new(contact: &'w Contact, workspace: &'w mut Workspace<'a>, with_gradients: bool) -> Walk<'w, 'a> {
        let course = Course { depth: 0, branch: None, turned: false, direction: 1.0, slides: false };
        Walk {
            contact,
            workspace,
            with_gradients,
            virgin: Virgin::NEW,
            depth: 0,
            sample: 0,
            displacement: 0.0,
            course,
            known: Some((0.0, 0.0)),
        }
    }

    fn advance(&mut self, sample: usize, energy: &mut Option<Dissipation>) {
        let target = self.workspace.displacement.get(sample).copied().unwrap_or(0.0);
        let used = self.workspace.reversals.get(..2 * self.depth).unwrap_or(&[]);
        let now = Reversal { displacement: self.displacement, force: 0.0 };
        let state = State::of(self.virgin, now, used);
        let slip = self.contact.slip_displacement;
        let mut course = memory::follow(&state, slip, target, |stretch| {
            if let Some(energy) = energy {
                energy.add(&stretch);
            }
        });
        if course.turned {
            let force = self.force();
            course.branch = Some(Reversal { displacement: self.displacement, force });
            self.remember(course.depth, force);
        }
        self.depth = course.depth;
        self.virgin = self.virgin.after(self.contact, &course, target);
        (self.sample, self.displacement, self.course, self.known) = (sample, target, course, None);
    }

    /// Keeps the point at hand as a reversal.
    fn remember(&mut self, depth: usize, force: f64) {
        if self.with_gradients {
            self.differentiate();
            let Workspace { gradients, row, coefficients, .. } = &mut *self.workspace;
            if let Some(gradient) = gradients.chunks_exact_mut((*coefficients).max(1)).nth(depth.wrapping_sub(1)) {
                gradient.iter_mut().zip(row.iter()).for_each(|(kept, now)| *kept = *now);
            }
        }
        let pair = self.workspace.reversals.chunks_exact_mut(2).nth(depth.wrapping_sub(1));
        if let Some([displacement, remembered]) = pair {
            (*displacement, *remembered) = (self.displacement, force);
        }
        if let Some(sample) = self.workspace.turned_at.get_mut(depth.wrapping_sub(1)) {
            *sample = self.sample as f64;
        }
    }

    fn point(&mut self) -> (f64, f64) {
        if let Some(known) = self.known {
            return known;
        }
        let Response { force, stiffness } =
            masing::response_at(self.contact, self.virgin.origin, &self.course, self.displacement);
        self.known = Some((force, stiffness));
        (force, stiffness)
    }

    fn force(&mut self) -> f64 {
        self.point().0
    }

    /// dT of the point at hand into the workspace's row: `k (dδ - dδ_r) + dT_r`.
    fn differentiate(&mut self) {
        let (_, stiffness) = self.point();
        let now = self.workspace.table_row(self.sample);
        let coefficients = self.workspace.coefficients;
        if self.depth == 0 {
            self.workspace.row.iter_mut().zip(now).for_each(|(row, now)| *row = stiffness * now);
            return;
        }
        let turned_at = self.workspace.turned_at.get(self.depth.wrapping_sub(1)).copied().unwrap_or(0.0);
        let then = self.workspace.table_row(turned_at as usize);
        let Workspace { gradients, row, .. } = &mut *self.workspace;
        let gradient = gradients.chunks_exact(coefficients.max(1)).nth(self.depth.wrapping_sub(1)).unwrap_or(&[]);
        for (((row, now), then), gradient) in row.iter_mut().zip(now).zip(then).zip(gradient) {
            *row = stiffness * (now - then) + gradient;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::tests::{FLATS, contact, ellipse};
    use std::vec;
    use std::vec::Vec;

    fn workspace(harmonics: usize, samples: usize) -> Vec<f64> {
        let mut memory = vec![0.0; workspace_length(harmonics, samples)];
        workspace_init(harmonics, samples, &mut memory).unwrap();
        memory
    }

    /// Force, Jacobian and energy.
    fn all(contact: &Contact, memory: &mut [f64], displacement: &[f64]) -> (Vec<f64>, Vec<f64>, f64) {
        let n = displacement.len();
        let (mut force, mut jacobian, mut energy) = (vec![f64::NAN; n], vec![f64::NAN; n * n], f64::NAN);
        let output =
            HarmonicOutput { force: Some(&mut force), jacobian: Some(&mut jacobian), dissipated: Some(&mut energy) };
        harmonic_force(contact, &mut Workspace::new(memory).unwrap(), displacement, output).unwrap();
        (force, jacobian, energy)
    }

    /// A motion that nests loops, in slip displacements.
    const SHAPE: [f64; 7] = [0.2, 0.5, -0.1, 0.05, 0.3, -0.35, 0.2];

    fn motion(contact: &Contact, size: f64) -> Vec<f64> {
        SHAPE.iter().map(|c| c * size * contact.slip_displacement).collect()
    }

    #[test]
    fn memory_that_is_no_workspace_is_refused() {
        let good = workspace(3, 16);
        for (place, value) in
            [(0, 0.0), (1, 0.0), (1, 2.5), (1, f64::NAN), (1, 8.0), (2, 6.0), (2, f64::INFINITY), (2, 1e12)]
        {
            let mut bad = good.clone();
            bad[place] = value;
            assert_eq!(Workspace::new(&mut bad).map(|_| ()), Err(Error::BadWorkspace), "{place} {value}");
        }
        let mut short = good.clone();
        short.pop();
        assert_eq!(Workspace::new(&mut short).map(|_| ()), Err(Error::BadWorkspace));
        assert_eq!(Workspace::new(&mut []).map(|_| ()), Err(Error::BadWorkspace));
        assert_eq!(workspace_extent(good.first_chunk().unwrap()), Ok(good.len()));
        // What lies beyond its extent is not touched.
        let mut long = vec![-1.0; good.len() + 2];
        workspace_init(3, 16, &mut long).unwrap();
        let contact = contact(50e-6);
        all(&contact, &mut long, &motion(&contact, 1.0));
        assert_eq!(long.get(good.len()..), Some(&[-1.0, -1.0][..]));
    }

    #[test]
    fn harmonics_samples_and_arrays_are_refused_by_name() {
        let mut memory = [0.0; 8];
        for (harmonics, samples, error) in [
            (0, 16, Error::BadHarmonics),
            (1 << 25, 1 << 26, Error::BadHarmonics),
            (3, 6, Error::BadSamples),
            (3, 1 << 25, Error::BadSamples),
            (usize::MAX, usize::MAX, Error::BadHarmonics),
        ] {
            assert_eq!(workspace_length(harmonics, samples), 0);
            assert_eq!(workspace_init(harmonics, samples, &mut memory), Err(error));
        }
        assert_eq!(workspace_init(3, 7, &mut memory), Err(Error::WorkspaceTooShort));
        assert_eq!(memory, [0.0; 8]);

        let (contact, mut good) = (contact(50e-6), workspace(1, 8));
        let mut refuses = |displacement: &[f64], length: usize, squared: usize, error: Error| {
            let (mut force, mut jacobian, mut energy) = (vec![7.0; length], vec![7.0; squared], 7.0);
            let output = HarmonicOutput {
                force: Some(&mut force),
                jacobian: Some(&mut jacobian),
                dissipated: Some(&mut energy),
            };
            let mut workspace = Workspace::new(&mut good).unwrap();
            assert_eq!(harmonic_force(&contact, &mut workspace, displacement, output), Err(error));
            assert!(energy == 7.0 && force.iter().chain(&jacobian).all(|value| *value == 7.0));
        };
        refuses(&[0.0; 2], 3, 9, Error::BadArraySize);
        refuses(&[0.0; 3], 2, 9, Error::BadArraySize);
        refuses(&[0.0; 3], 3, 8, Error::BadArraySize);
        refuses(&[0.0, f64::NAN, 0.0], 3, 9, Error::BadDisplacement);
        refuses(&[0.0, 0.0, 1.1e150], 3, 9, Error::BadDisplacement);
    }

    /// The trapezoidal sum over a period errs by the jumps of odd derivatives. At a reversal the first has none: samples⁻⁴
    /// where samples are reversals, but samples⁻² where they miss them, by a part of a step, and the loop is smaller.
    #[test]
    fn one_harmonic_tends_to_the_complex_stiffness_as_samples_to_the_minus_two_or_four() {
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let amplitude = 0.7 * contact.slip_displacement;
            let exact = contact.complex_stiffness(amplitude).unwrap();
            for (missed, power) in [(0.0, 4), (0.5, 2)] {
                let off = [64, 128, 256, 512].map(|samples| {
                    let (sine, cosine) = (2.0 * PI * missed / samples as f64).sin_cos();
                    let displacement = [0.0, amplitude * cosine, amplitude * sine];
                    let (force, _, energy) = all(&contact, &mut workspace(1, samples), &displacement);
                    // Where the reversals are samples the energy is that of the loop at once.
                    assert!(missed > 0.0 || (energy / exact.dissipated() - 1.0).abs() < 1e-13);
                    // Turned back by what was missed; F = (K' + iK'') A is K' A cos t - K'' A sin t.
                    let real = (cosine * force[1] + sine * force[2]) / amplitude;
                    let imaginary = (sine * force[1] - cosine * force[2]) / amplitude;
                    (real - exact.real()).hypot(imaginary - exact.imaginary())
                });
                for pair in off.windows(2) {
                    // The next term is smaller by samples⁻², with a factor below 100. Rounding ends it.
                    let falls = (0.95..1.05).contains(&(pair[0] / pair[1] / 2f64.powi(power)));
                    assert!(falls || pair[1] < 1e-13 * exact.real(), "{missed} {off:?} {}", exact.real());
                }
                assert!(off[3] < 1e-4 * exact.imaginary() + 1e-13 * exact.real(), "{missed} {off:?}");
            }
        }
    }

    #[test]
    fn a_shift_in_time_shifts_force_and_jacobian() {
        let samples = 48;
        for (contact, size) in [(contact(50e-6), 0.9), (contact(0.0), 0.5), (contact(1e-6), 2.5)] {
            let mut memory = workspace(3, samples);
            let n = SHAPE.len();
            let displacement = motion(&contact, size);
            let (force, jacobian, energy) = all(&contact, &mut memory, &displacement);
            for by in [1, 7, 24, 31] {
                // Each pair (cos k, sin k) turns by k times the shift.
                let turn = |vector: &[f64]| {
                    let mut turned = vector.to_vec();
                    for k in 1..=n / 2 {
                        let (sine, cosine) = (2.0 * PI * (k * by) as f64 / samples as f64).sin_cos();
                        let (a, b) = (vector[2 * k - 1], vector[2 * k]);
                        turned[2 * k - 1] = cosine * a + sine * b;
                        turned[2 * k] = cosine * b - sine * a;
                    }
                    turned
                };
                let (shifted, its_jacobian, same) = all(&contact, &mut memory, &turn(&displacement));
                assert!((same / energy - 1.0).abs() < 1e-12, "{by}");
                for (one, two) in shifted.iter().zip(turn(&force)) {
                    // Displacements come out of the turn with a few units of rounding.
                    assert!((one - two).abs() < 2e-14 * contact.slip_force, "{by}");
                }
                // J R = R J, column by column.
                for j in 0..n {
                    let mut unit = vec![0.0; n];
                    unit[j] = 1.0;
                    let times = |matrix: &[f64], vector: &[f64]| -> Vec<f64> {
                        (0..n).map(|i| (0..n).map(|k| matrix[i + n * k] * vector[k]).sum()).collect()
                    };
                    let one = times(&its_jacobian, &turn(&unit));
                    let two = turn(&times(&jacobian, &unit));
                    for (one, two) in one.iter().zip(two) {
                        // Near gross slip a unit of rounding of the displacement is worth many of the stiffness.
                        assert!((one - two).abs() < 1e-9 * contact.initial_stiffness, "{by}: {one} {two}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_small_motion_meets_a_spring_and_a_large_one_a_square_wave() {
        let contact = contact(0.0);
        let mut memory = workspace(3, 32);
        let (_, jacobian, _) = all(&contact, &mut memory, &[1e-9 * contact.slip_displacement; 7]);
        for (place, value) in jacobian.iter().enumerate() {
            let expected = if place % 8 == 0 { contact.initial_stiffness } else { 0.0 };
            // The bend of the curve is 1e-9 of its slope there.
            assert!((value - expected).abs() < 1e-8 * contact.initial_stiffness, "{place}");
        }
        let huge = 1e9 * contact.slip_displacement;
        let (force, _, energy) = all(&contact, &mut memory, &[0.0, 0.0, huge, 0.0, 0.0, 0.0, 0.0]);
        // The sign of cos at 32 samples has cot(π/32)/8 for 4/π.
        assert!((force[1] / contact.slip_force * (PI / 32.0).tan() * 8.0 - 1.0).abs() < 1e-14);
        assert!((energy / (4.0 * contact.slip_force * huge) - 1.0).abs() < 1e-8);
    }

    #[test]
    fn nothing_depends_on_what_the_workspace_did_before() {
        let (contact, mut memory) = (contact(50e-6), workspace(3, 32));
        let first = all(&contact, &mut memory, &motion(&contact, 0.8));
        all(&contact, &mut memory, &motion(&contact, -3.0));
        assert_eq!(all(&contact, &mut memory, &motion(&contact, 0.8)), first);
        // Outputs that are not wanted change nothing in the others.
        let mut force = vec![0.0; 7];
        let output = HarmonicOutput { force: Some(&mut force), jacobian: None, dissipated: None };
        let mut workspace = Workspace::new(&mut memory).unwrap();
        harmonic_force(&contact, &mut workspace, &motion(&contact, 0.8), output).unwrap();
        assert_eq!(force, first.0);
    }
}
