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
use crate::curve::check_displacement;
use crate::error::Error;
use crate::masing::{self, Course, Dissipation, Reversal, State, Virgin};
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
        // Far beyond any use, and small enough that no size below overflows.
        const LARGEST: usize = 1 << 24;
        if !(1..=LARGEST).contains(&harmonics) {
            return Err(Error::BadHarmonics);
        }
        if samples <= 2 * harmonics || samples > LARGEST {
            return Err(Error::BadSamples);
        }
        Ok(Layout { coefficients: 2 * harmonics + 1, samples })
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
    let &[mark, harmonics, samples] = header;
    // Compared as doubles: a conversion of what is no number would trap.
    let whole = |value: f64| (1.0..=16_777_216.0).contains(&value) && value.floor() == value;
    if mark.to_bits() != MARK.to_bits() || !whole(harmonics) || !whole(samples) {
        return Err(Error::BadWorkspace);
    }
    Layout::new(harmonics as usize, samples as usize).map(|layout| layout.length()).map_err(|_| Error::BadWorkspace)
}

impl<'a> Workspace<'a> {
    /// Takes a prepared workspace into use.
    ///
    /// # Errors
    /// `BadWorkspace` for memory that was not initialised, or was changed.
    pub fn new(workspace: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let header = workspace.first_chunk::<HEADER>().ok_or(Error::BadWorkspace)?;
        let extent = workspace_extent(header)?;
        let &[_, harmonics, samples] = header;
        let layout = Layout::new(harmonics as usize, samples as usize).map_err(|_| Error::BadWorkspace)?;
        let rest = workspace.get_mut(HEADER..extent).ok_or(Error::BadWorkspace)?;
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
        *dissipated = energy.sum;
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
        let mut course = masing::follow(&state, slip, target, |stretch| {
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
        let (force, stick) = masing::force_at(self.contact, self.virgin.origin, &self.course, self.displacement);
        let stiffness = stick.map_or(0.0, |stick| self.contact.stiffness_of(&stick));
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
