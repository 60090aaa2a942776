//! Harmonic force by alternating between frequency and time, with its exact Jacobian.
//!
//! The displacement `c0 + Σ (a_k cos kt + b_k sin kt)` is sampled at equidistant instants, the contact is led through the
//! steady state, and its forces are transformed back. The steady state is that of the second of two periods from the virgin
//! state. It starts where the displacement is farthest from 0: there nothing is remembered but the virgin curve, whatever was
//! before. So one period is walked, from that sample; and half of it where the displacement has odd harmonics only, for
//! then force and displacement change their sign with half a period.
//!
//! The Jacobian follows the memory exactly. On a branch from a reversal r, `T = T_r ± 2 M⁻¹(|δ-δ_r|/2)`, so that with the
//! tangent stiffness k of the branch and φ the row 1, cos t, sin t, cos 2t, ... of a sample
//!
//! ```text
//! dT = k (φ - φ_r) + dT_r,        J = Σ φ ⊗ dT = Σ k φ ⊗ φ - Σ_r (Σ k φ) ⊗ φ_r + Σ_r (Σ φ) ⊗ dT_r,
//! ```
//!
//! the inner sums over the samples on one branch. The first sum is made of the Fourier sums of k up to the order 2H, the last
//! is geometric, and `dT_r` was known when the reversal was passed.

use crate::contact::Contact;
use crate::curve::{Responder, Response, check_displacement};
use crate::error::Error;
use crate::masing::Dissipation;
use crate::memory::{self, Reversal, State, Stretch, Virgin};
use crate::seal::Kind;
use crate::waves::{add_products, clear_other_parity, fill_columns, sample, scale, wave};
use crate::workspace::{Blocks, HEADER, Parts, Size, read_header, sealed_parts};
use core::f64::consts::PI;

/// Numbers of doubles in the parts of a workspace.
struct Layout(Size);

impl Layout {
    fn new(harmonics: usize, samples: usize) -> Result<Layout, Error> {
        Size::new(harmonics, samples, |size| size.samples + 8).map(Layout)
    }

    /// Samples after which the tables repeat, but for the sign of odd orders: half a period if it has a middle.
    fn half(&self) -> usize {
        if self.0.samples.is_multiple_of(2) { self.0.samples / 2 } else { self.0.samples }
    }

    /// A period nests at most as many reversals as it has samples.
    fn reversals(&self) -> usize {
        self.0.samples + 1
    }

    /// Blocks of four numbers for the orders of one parity up to `largest`.
    fn blocks(largest: usize) -> usize {
        (largest + 1).div_ceil(4)
    }

    fn tables(&self) -> usize {
        let up_to_2h = 4 * Layout::blocks(2 * self.0.harmonics);
        self.half() * (self.0.coefficients() + 2 * up_to_2h) + self.0.harmonics
    }

    fn length(&self) -> usize {
        let (up_to_h, up_to_2h) = (4 * Layout::blocks(self.0.harmonics), 4 * Layout::blocks(2 * self.0.harmonics));
        let walk = 3 * self.0.samples + self.reversals() * (3 + self.0.coefficients());
        HEADER + self.tables() + walk + 2 * up_to_h + 4 * up_to_2h + 4 * self.0.coefficients()
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
    let Some(memory) = workspace.get_mut(..layout.length()) else { return Err(Error::WorkspaceTooShort) };
    layout.0.begin(Kind::Equidistant, memory, layout.tables(), |parts| fill_tables(parts, &layout))
}

fn fill_tables(parts: &mut Parts, layout: &Layout) -> Result<(), Error> {
    let (Size { harmonics, samples }, half) = (layout.0, layout.half());
    fill_columns(parts.take(half * layout.0.coefficients())?, samples, half);
    for parity in [0, 1] {
        let blocks = parts.take_blocks(half * Layout::blocks(2 * harmonics))?;
        for (first, block) in (0..).step_by(4).zip(blocks.chunks_exact_mut(half.max(1))) {
            for (sample, row) in block.iter_mut().enumerate() {
                *row = [first, first + 1, first + 2, first + 3].map(|place| {
                    let order = order_at(place, parity);
                    let (cosine, sine) = wave(order, sample, samples);
                    if order > 2 * harmonics {
                        0.0
                    } else if place == order && order > 0 {
                        sine
                    } else {
                        cosine
                    }
                });
            }
        }
    }
    // 1/(exp(imΔ) - 1) = -1/2 - (i/2) cot(mΔ/2), Δ one step.
    for (m, cotangent) in (1..).zip(parts.take(harmonics)?) {
        let (sine, cosine) = (PI * m as f64 / samples as f64).sin_cos();
        *cotangent = 0.5 * cosine / sine;
    }
    Ok(())
}

/// The orders of one parity stand side by side, cosines before sines: 1, cos 2t, sin 2t, cos 4t, ... and cos t, sin t, cos 3t,
/// ... The sine of an order has the order's own number, the cosine the one before; the order 0 has no sine.
#[inline(always)]
fn order_at(place: usize, parity: usize) -> usize {
    place + (place + parity) % 2
}

/// A workspace as it is used.
#[derive(Debug)]
pub struct Workspace<'a> {
    harmonics: usize,
    samples: usize,
    half: usize,
    /// Over the samples of half a period, for each coefficient: 1, cos t, sin t, cos 2t, ...
    columns: &'a [f64],
    /// Even and odd orders up to 2H, four numbers of each sample together, over the samples of half a period.
    tables: [&'a Blocks; 2],
    /// cot(π m/samples)/2 for the orders m.
    cotangents: &'a [f64],
    displacement: &'a mut [f64],
    force: &'a mut [f64],
    stiffness: &'a mut [f64],
    /// Displacement and force of each reversal.
    reversals: &'a mut [f64],
    /// Sample of each reversal.
    turned_at: &'a mut [f64],
    /// dT_r of each reversal, a row over the coefficients.
    gradients: &'a mut [f64],
    /// Fourier sums: of the force, of the stiffness on one branch and on all.
    force_sums: Sums<'a>,
    branch_sums: Sums<'a>,
    stiffness_sums: Sums<'a>,
    /// Rows over the coefficients: φ_r, Σ φ and Σ k φ of a branch, and one more.
    start: &'a mut [f64],
    waves: &'a mut [f64],
    weighted: &'a mut [f64],
    row: &'a mut [f64],
}

/// Doubles that a prepared workspace occupies, from what it begins with.
///
/// # Errors
/// `BadWorkspace` for memory that was not initialised, or was changed.
pub fn workspace_extent(header: &[f64; HEADER]) -> Result<usize, Error> {
    layout_of(header).map(|layout| layout.length())
}

fn layout_of(header: &[f64; HEADER]) -> Result<Layout, Error> {
    let (harmonics, samples) = read_header(Kind::Equidistant, header)?;
    Layout::new(harmonics, samples).map_err(|_| Error::BadWorkspace)
}

impl<'a> Workspace<'a> {
    /// Takes a prepared workspace into use.
    ///
    /// # Errors
    /// `BadWorkspace` for memory that was not initialised, or was changed.
    #[inline(always)]
    pub fn new(workspace: &'a mut [f64]) -> Result<Workspace<'a>, Error> {
        let layout = layout_of(workspace.first_chunk::<HEADER>().ok_or(Error::BadWorkspace)?)?;
        let (half, coefficients) = (layout.half(), layout.0.coefficients());
        let (up_to_h, up_to_2h) = (Layout::blocks(layout.0.harmonics), Layout::blocks(2 * layout.0.harmonics));
        let mut parts = sealed_parts(workspace, layout.length(), layout.tables())?;
        Ok(Workspace {
            harmonics: layout.0.harmonics,
            samples: layout.0.samples,
            half,
            columns: parts.take(half * coefficients)?,
            tables: [parts.take_blocks(half * up_to_2h)?, parts.take_blocks(half * up_to_2h)?],
            cotangents: parts.take(layout.0.harmonics)?,
            displacement: parts.take(layout.0.samples)?,
            force: parts.take(layout.0.samples)?,
            stiffness: parts.take(layout.0.samples)?,
            reversals: parts.take(2 * layout.reversals())?,
            turned_at: parts.take(layout.reversals())?,
            gradients: parts.take(layout.reversals() * coefficients)?,
            force_sums: Sums([parts.take_blocks(up_to_h)?, parts.take_blocks(up_to_h)?]),
            branch_sums: Sums([parts.take_blocks(up_to_2h)?, parts.take_blocks(up_to_2h)?]),
            stiffness_sums: Sums([parts.take_blocks(up_to_2h)?, parts.take_blocks(up_to_2h)?]),
            start: parts.take(coefficients)?,
            waves: parts.take(coefficients)?,
            weighted: parts.take(coefficients)?,
            row: parts.take(coefficients)?,
        })
    }

    /// 2H + 1.
    #[must_use]
    pub fn coefficients(&self) -> usize {
        2 * self.harmonics + 1
    }
}

/// Fourier sums over even and over odd orders.
#[derive(Debug)]
struct Sums<'a>([&'a mut Blocks; 2]);

impl Sums<'_> {
    #[inline(always)]
    fn clear(&mut self) {
        self.0.iter_mut().for_each(|blocks| blocks.fill([0.0; 4]));
    }

    /// Adds consecutive samples to the sums over one parity.
    #[inline(always)]
    fn add(&mut self, tables: &[&Blocks; 2], parity: usize, rows: &Rows, samples: &[f64]) {
        let (Some(sums), Some(table)) = (self.0.get_mut(parity), tables.get(parity)) else { return };
        let sign = if parity == 1 { rows.sign } else { 1.0 };
        for (sum, block) in sums.iter_mut().zip(table.chunks_exact(rows.half.max(1))) {
            let part = weighted_sum(block.get(rows.first..).unwrap_or(&[]), samples);
            sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += sign * part);
        }
    }

    #[inline(always)]
    fn add_all(&mut self, others: &Sums) {
        for (sums, others) in self.0.iter_mut().zip(&others.0) {
            for (sum, other) in sums.iter_mut().zip(others.iter()) {
                sum.iter_mut().zip(other).for_each(|(sum, other)| *sum += other);
            }
        }
    }

    /// Cosine and sine sum of an order; the order 0 has no sine.
    #[inline(always)]
    fn of_order(&self, order: usize) -> (f64, f64) {
        let [even, odd] = &self.0;
        let sums = if order.is_multiple_of(2) { even } else { odd }.as_flattened();
        let at = |place: usize| sums.get(place).copied().unwrap_or(0.0);
        if order == 0 { (at(0), 0.0) } else { (at(order - 1), at(order)) }
    }

    /// All sums up to order H as a row over the coefficients.
    #[inline(always)]
    fn spread(&self, row: &mut [f64]) {
        let Some((constant, pairs)) = row.split_first_mut() else { return };
        *constant = self.of_order(0).0;
        for (order, pair) in (1..).zip(pairs.as_chunks_mut::<2>().0) {
            *pair = self.of_order(order).into();
        }
    }
}

/// Where consecutive samples, all in one half of the period, have their rows of the tables.
#[derive(Debug, Clone, Copy)]
struct Rows {
    half: usize,
    first: usize,
    /// Of odd orders.
    sign: f64,
}

impl Rows {
    #[inline(always)]
    fn of(sample: usize, half: usize) -> Rows {
        if sample < half {
            Rows { half, first: sample, sign: 1.0 }
        } else {
            Rows { half, first: sample - half, sign: -1.0 }
        }
    }
}

/// The sum of rows, each times its weight: two sums, so that one need not wait for the other.
#[inline(always)]
fn weighted_sum(rows: &Blocks, weights: &[f64]) -> [f64; 4] {
    let (mut one, mut two) = ([0.0; 4], [0.0; 4]);
    let rows = rows.get(..weights.len()).unwrap_or(&[]);
    let (row_pairs, last_row) = rows.as_chunks::<2>();
    let (weight_pairs, last_weight) = weights.as_chunks::<2>();
    for ([first, second], [a, b]) in row_pairs.iter().zip(weight_pairs) {
        for k in 0..4 {
            one[k] += a * first[k];
            two[k] += b * second[k];
        }
    }
    if let (&[row], &[weight]) = (last_row, last_weight) {
        for k in 0..4 {
            one[k] += weight * row[k];
        }
    }
    for k in 0..4 {
        one[k] += two[k];
    }
    one
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

impl HarmonicOutput<'_> {
    /// Checks all lengths and coefficients, and clears the Jacobian; whether nothing is wanted, or all of it is zero and done.
    ///
    /// # Errors
    /// `BadDisplacement`, `BadArraySize`.
    #[inline(always)]
    pub(crate) fn is_trivial(&mut self, contact: &Contact, n: usize, displacement: &[f64]) -> Result<bool, Error> {
        let HarmonicOutput { force, jacobian, dissipated } = self;
        let fits = |output: &Option<&mut [f64]>, length: usize| output.as_ref().is_none_or(|o| o.len() == length);
        if displacement.len() != n || !fits(force, n) || !fits(jacobian, n * n) {
            return Err(Error::BadArraySize);
        }
        check_coefficients(displacement)?;
        if let Some(jacobian) = jacobian {
            jacobian.fill(0.0);
        }
        if contact.is_frictionless() {
            if let Some(force) = force {
                force.fill(0.0);
            }
            if let Some(dissipated) = dissipated {
                **dissipated = 0.0;
            }
            return Ok(true);
        }
        Ok(force.is_none() && jacobian.is_none() && dissipated.is_none())
    }
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
#[inline(always)]
pub fn harmonic_force(
    contact: &Contact,
    workspace: &mut Workspace,
    displacement: &[f64],
    output: HarmonicOutput,
) -> Result<(), Error> {
    let n = workspace.coefficients();
    let mut output = output;
    if output.is_trivial(contact, n, displacement)? {
        return Ok(());
    }
    let HarmonicOutput { force, mut jacobian, dissipated } = output;
    let mirrored = sample(workspace.columns, workspace.half, workspace.displacement, displacement);
    let mut walk = Walk {
        contact,
        wanted: Wanted { force: force.is_some(), stiffness: jacobian.is_some(), mirrored },
        energy: dissipated.is_some().then(|| Dissipation::new(contact)),
        virgin: Virgin::NEW,
        depth: 0,
        branch: Branch::VIRGIN,
    };
    walk.through_period(workspace, &mut jacobian);
    if let (Some(dissipated), Some(energy)) = (dissipated, walk.energy) {
        *dissipated = if mirrored { 2.0 * energy.total() } else { energy.total() };
    }
    // The half that was not walked counts as much as the other.
    let mean = if mirrored { 2.0 } else { 1.0 } / workspace.samples as f64;
    if let Some(force) = force {
        workspace.force_sums.spread(force);
        scale(force, mean);
    }
    if let Some(jacobian) = jacobian {
        add_products(jacobian, workspace.harmonics, |order| workspace.stiffness_sums.of_order(order));
        for (c, column) in jacobian.chunks_exact_mut(n.max(1)).enumerate() {
            scale(column, mean);
            if mirrored {
                clear_other_parity(c, column);
            }
        }
    }
    Ok(())
}

/// What of each sample is needed.
#[derive(Debug, Clone, Copy)]
struct Wanted {
    force: bool,
    stiffness: bool,
    /// Of one half of the period: the other is its mirror image.
    mirrored: bool,
}

/// How many values one after the other, at most `left`, are not the first that `ends` says ends their run; and the last of
/// them.
#[inline(always)]
fn run(parts: [&[f64]; 2], left: usize, first: f64, ends: impl Fn(f64, f64) -> bool) -> (usize, f64) {
    let (mut at, mut count) = (first, 0);
    for part in parts {
        for &next in part.get(..left - count).unwrap_or(part) {
            if ends(at, next) {
                return (count, at);
            }
            at = next;
            count += 1;
        }
    }
    (count, at)
}

/// A branch of the walk: the virgin curve, one from a reversal, or gross slip.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Branch {
    /// Where it starts.
    pub from: Reversal,
    /// Direction +1 or -1, and the displacement at which it ends.
    pub direction: f64,
    pub end: f64,
    pub slides: bool,
    /// Two half-curves make a branch, one the virgin curve.
    pub halves: f64,
    /// Whether it starts at a reversal.
    pub reversed: bool,
}

impl Branch {
    pub const VIRGIN: Branch = Branch {
        // No force; with this sign a vector of both is no extension by zero, for which compilers have an instruction that
        // valgrind does not know.
        from: Reversal { displacement: 0.0, force: -0.0 },
        direction: 1.0,
        end: 0.0,
        slides: false,
        halves: 1.0,
        reversed: false,
    };

    /// The branch from the newest of so many reversals, or the virgin curve.
    #[inline(always)]
    pub fn newest(reversals: &[f64], depth: usize, origin: f64, direction: f64, slip_displacement: f64) -> Branch {
        let reversal = |depth: usize| reversals.as_chunks::<2>().0.get(depth.wrapping_sub(1));
        match reversal(depth) {
            Some(&[displacement, force]) => {
                let older = reversal(depth.wrapping_sub(1));
                let end = older.map_or(2.0 * origin - displacement, |[older, _]| *older);
                let from = Reversal { displacement, force };
                Branch { from, direction, end, slides: false, halves: 2.0, reversed: true }
            }
            None => Branch {
                from: Reversal { displacement: origin, ..Branch::VIRGIN.from },
                direction,
                end: origin + direction * slip_displacement,
                ..Branch::VIRGIN
            },
        }
    }

    /// Where a displacement lies on the monotonic curve.
    #[inline(always)]
    pub fn way(&self, slip_displacement: f64, displacement: f64) -> f64 {
        let way = (displacement - self.from.displacement).abs() / self.halves;
        // One that reaches gross slip only by rounding ends where that begins.
        if way > slip_displacement { slip_displacement } else { way }
    }

    #[inline(always)]
    pub fn responder<'c>(&self, contact: &'c Contact) -> BranchResponder<'c> {
        let towards = self.direction * self.halves;
        BranchResponder { branch: *self, towards, limit: contact.slip_force, curve: contact.responder() }
    }
}

/// Finds force and stiffness at displacements on a branch that does not slide.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BranchResponder<'c> {
    branch: Branch,
    /// Its direction, and twice that for a whole branch.
    towards: f64,
    limit: f64,
    curve: Responder<'c>,
}

impl BranchResponder<'_> {
    #[inline(always)]
    pub fn at(&self, displacement: f64) -> Response {
        let BranchResponder { branch, towards, limit, curve } = self;
        let Response { force, stiffness } = curve.at(branch.way(curve.slip_displacement, displacement));
        let force = branch.from.force + towards * force;
        let force = if force > *limit { *limit } else { force };
        Response { force: if force < -limit { -limit } else { force }, stiffness }
    }
}

/// The walk through the steady state.
struct Walk<'c> {
    contact: &'c Contact,
    wanted: Wanted,
    energy: Option<Dissipation<'c>>,
    virgin: Virgin,
    depth: usize,
    branch: Branch,
}

impl Walk<'_> {
    /// Leads the contact from the farthest sample through a period, or half of it: the Fourier sums, and the Jacobian's part of
    /// every reversal.
    #[inline(always)]
    fn through_period(&mut self, workspace: &mut Workspace, jacobian: &mut Option<&mut [f64]>) {
        let samples = workspace.samples;
        let after = |sample: usize| if sample + 1 >= samples { 0 } else { sample + 1 };
        let mut left = if self.wanted.mirrored { workspace.half } else { samples };
        let mut before = workspace.farthest(left);
        self.begin(workspace, before);
        workspace.force_sums.clear();
        workspace.stiffness_sums.clear();
        while left > 0 {
            let sample = after(before);
            self.pass(workspace, before, sample);
            let count = 1 + self.stay(workspace.displacement, sample, left - 1);
            before = self.follow_branch(workspace, sample, count, jacobian);
            left -= count;
        }
    }

    /// How many samples after this one, at most `left`, lie on the branch as well.
    #[inline(always)]
    fn stay(&mut self, displacement: &[f64], sample: usize, left: usize) -> usize {
        let (ahead, behind) =
            displacement.split_at_checked(sample + 1).map_or((&[][..], displacement), |(b, a)| (a, b));
        let entered = behind.last().copied().unwrap_or(0.0);
        let Branch { direction, end, slides, .. } = self.branch;
        let (count, at) = if direction > 0.0 {
            let end = if slides { f64::INFINITY } else { end };
            run([ahead, behind], left, entered, |at, next| next < at || next >= end)
        } else {
            let end = if slides { f64::NEG_INFINITY } else { end };
            run([ahead, behind], left, entered, |at, next| next > at || next <= end)
        };
        if count > 0 {
            self.account_for(entered, at);
        }
        count
    }

    /// The virgin curve at the farthest sample.
    #[inline(always)]
    fn begin(&mut self, workspace: &mut Workspace, sample: usize) {
        let slip = self.contact.slip_displacement;
        let displacement = workspace.displacement.get(sample).copied().unwrap_or(0.0);
        let direction = if displacement < 0.0 { -1.0 } else { 1.0 };
        self.branch = Branch { direction, slides: displacement.abs() > slip, ..Branch::VIRGIN };
        let parts = (workspace.force.get_mut(sample), workspace.stiffness.get_mut(sample));
        let (Some(force), Some(stiffness)) = parts else { return };
        if self.branch.slides {
            self.virgin = Virgin { origin: displacement - direction * slip, slid: direction };
            *force = direction * self.contact.slip_force;
            *stiffness = 0.0;
        } else {
            Response { force: *force, stiffness: *stiffness } = self.branch.responder(self.contact).at(displacement);
        }
    }

    /// A step that may turn, close loops or slip: on which branch it ends.
    #[inline(always)]
    fn pass(&mut self, workspace: &mut Workspace, before: usize, sample: usize) {
        let displacement = |sample: usize| workspace.displacement.get(sample).copied().unwrap_or(0.0);
        let (from, target) = (displacement(before), displacement(sample));
        let now = Reversal { displacement: from, force: workspace.force.get(before).copied().unwrap_or(0.0) };
        let used = workspace.reversals.get(..2 * self.depth).unwrap_or(&[]);
        let state = State::of(self.virgin, now, used);
        let slip = self.contact.slip_displacement;
        let energy = &mut self.energy;
        let course = memory::follow(&state, slip, target, |stretch| {
            if let Some(energy) = energy {
                energy.add(&stretch);
            }
        });
        if course.turned {
            self.remember(workspace, before, now);
        }
        self.depth = course.depth;
        self.virgin = self.virgin.after(self.contact, &course, target);
        let newest = Branch::newest(workspace.reversals, course.depth, self.virgin.origin, course.direction, slip);
        self.branch = Branch { slides: course.slides, ..newest };
    }

    /// Keeps the point at a sample as the newest reversal.
    #[inline(always)]
    fn remember(&self, workspace: &mut Workspace, sample: usize, now: Reversal) {
        let depth = self.depth;
        if self.wanted.stiffness {
            workspace.differentiate(sample, if self.branch.reversed { depth } else { 0 });
            let n = workspace.coefficients().max(1);
            if let Some(gradient) = workspace.gradients.chunks_exact_mut(n).nth(depth) {
                gradient.iter_mut().zip(workspace.row.iter()).for_each(|(kept, now)| *kept = *now);
            }
        }
        if let Some([displacement, force]) = workspace.reversals.chunks_exact_mut(2).nth(depth) {
            (*displacement, *force) = (now.displacement, now.force);
        }
        if let Some(turned_at) = workspace.turned_at.get_mut(depth) {
            *turned_at = sample as f64;
        }
    }

    /// The energy of a stretch within a branch; gross slip carries the virgin curve along.
    #[inline(always)]
    fn account_for(&mut self, from: f64, to: f64) {
        let Branch { slides, direction, halves, .. } = self.branch;
        if slides {
            self.virgin.origin = to - direction * self.contact.slip_displacement;
        }
        if let Some(energy) = &mut self.energy {
            let way = |displacement: f64| self.branch.way(self.contact.slip_displacement, displacement);
            energy.add(&if slides {
                Stretch { halves: 1.0, from: 0.0, to: 0.0, slipped: (to - from).abs() }
            } else {
                Stretch { halves, from: way(from), to: way(to), slipped: 0.0 }
            });
        }
    }

    /// Force and stiffness of consecutive samples on the branch, their Fourier sums, and the branch's part of the Jacobian
    /// beyond `Σ k φ ⊗ φ`; the last of the samples.
    #[inline(always)]
    fn follow_branch(
        &self,
        workspace: &mut Workspace,
        first: usize,
        count: usize,
        jacobian: &mut Option<&mut [f64]>,
    ) -> usize {
        let (branch, contact, wanted) = (self.branch, self.contact, self.wanted);
        let responder = branch.responder(contact);
        let (mut next, mut left) = (first, count);
        if wanted.stiffness && !branch.slides {
            workspace.branch_sums.clear();
        }
        while left > 0 {
            // Neither beyond the middle, where the tables begin anew, nor beyond the end.
            let boundary = if next < workspace.half { workspace.half } else { workspace.samples };
            let rows = Rows::of(next, workspace.half);
            let range = next..boundary.min(next + left);
            let length = range.len();
            next = if range.end == workspace.samples { 0 } else { range.end };
            left -= length;
            if !(wanted.force || wanted.stiffness) {
                continue;
            }
            let parts = (
                workspace.displacement.get(range.clone()),
                workspace.force.get_mut(range.clone()),
                workspace.stiffness.get_mut(range),
            );
            let (Some(displacement), Some(force), Some(stiffness)) = parts else { break };
            if branch.slides {
                force.fill(branch.direction * contact.slip_force);
                stiffness.fill(0.0);
            } else if wanted.stiffness {
                for ((force, stiffness), &displacement) in force.iter_mut().zip(stiffness.iter_mut()).zip(displacement)
                {
                    Response { force: *force, stiffness: *stiffness } = responder.at(displacement);
                }
                workspace.branch_sums.add(&workspace.tables, 0, &rows, stiffness);
                workspace.branch_sums.add(&workspace.tables, 1, &rows, stiffness);
            } else {
                for (force, &displacement) in force.iter_mut().zip(displacement) {
                    *force = responder.at(displacement).force;
                }
            }
            if wanted.force {
                if !wanted.mirrored {
                    workspace.force_sums.add(&workspace.tables, 0, &rows, force);
                }
                workspace.force_sums.add(&workspace.tables, 1, &rows, force);
            }
        }
        if let Some(jacobian) = jacobian
            && !branch.slides
        {
            workspace.stiffness_sums.add_all(&workspace.branch_sums);
            if branch.reversed {
                workspace.add_reversal(first, next, count, self.depth, jacobian);
            }
        }
        if next == 0 { workspace.samples - 1 } else { next - 1 }
    }
}

impl Workspace<'_> {
    /// The first of the samples farthest from 0, among so many.
    #[inline(always)]
    fn farthest(&self, among: usize) -> usize {
        let samples = self.displacement.get(..among).unwrap_or(self.displacement);
        let larger = |one: f64, two: f64| if two > one { two } else { one };
        let (fours, others) = samples.as_chunks::<4>();
        let mut lanes = [0.0; 4];
        for four in fours {
            for k in 0..4 {
                lanes[k] = larger(lanes[k], four[k].abs());
            }
        }
        let [one, two, three, four] = lanes;
        let mut largest = larger(larger(one, two), larger(three, four));
        for other in others {
            largest = larger(largest, other.abs());
        }
        samples.iter().position(|value| value.abs() == largest).unwrap_or(0)
    }

    /// φ of a sample into a row over the coefficients.
    #[inline(always)]
    fn phi(columns: &[f64], half: usize, sample: usize, row: &mut [f64]) {
        let Rows { first, sign, .. } = Rows::of(sample, half);
        let half = half.max(1);
        let Some((constant, pairs)) = row.split_first_mut() else { return };
        *constant = 1.0;
        let mut odd = true;
        let waves = columns.get(half..).unwrap_or(&[]).chunks_exact((2 * half).max(1));
        for ([cosine, sine], columns) in pairs.as_chunks_mut::<2>().0.iter_mut().zip(waves) {
            let at = |place: usize| columns.get(place).copied().unwrap_or(0.0);
            let sign = if odd { sign } else { 1.0 };
            (*cosine, *sine) = (sign * at(first), sign * at(half + first));
            odd = !odd;
        }
    }

    /// dT of a sample on the branch from the reversal of that depth, the virgin curve at 0: `k (φ - φ_r) + dT_r`.
    #[inline(always)]
    fn differentiate(&mut self, sample: usize, depth: usize) {
        let k = self.stiffness.get(sample).copied().unwrap_or(0.0);
        Self::phi(self.columns, self.half, sample, self.row);
        if let Some(depth) = depth.checked_sub(1) {
            let turned_at = self.turned_at.get(depth).copied().unwrap_or(0.0);
            Self::phi(self.columns, self.half, turned_at as usize, self.start);
            let gradient = self.gradients.chunks_exact(2 * self.harmonics + 1).nth(depth).unwrap_or(&[]);
            for ((row, start), gradient) in self.row.iter_mut().zip(self.start.iter()).zip(gradient) {
                *row = k * (*row - start) + gradient;
            }
        } else {
            self.row.iter_mut().for_each(|row| *row *= k);
        }
    }

    /// Adds `(Σ φ) ⊗ dT_r - (Σ k φ) ⊗ φ_r` of a branch that begins with sample `first`, `count` long, so that `next` follows.
    #[inline(always)]
    fn add_reversal(&mut self, first: usize, next: usize, count: usize, depth: usize, jacobian: &mut [f64]) {
        let n = self.coefficients().max(1);
        let (columns, half) = (self.columns, self.half);
        Self::phi(columns, half, first, self.start);
        Self::phi(columns, half, next, self.row);
        // Σ exp(imt) = [exp(im t_next) - exp(im t_first)]/(exp(imΔ) - 1).
        if let Some(waves) = self.waves.first_mut() {
            *waves = count as f64;
        }
        for (((sum, first), next), cotangent) in self
            .waves
            .get_mut(1..)
            .unwrap_or(&mut [])
            .chunks_exact_mut(2)
            .zip(self.start.get(1..).unwrap_or(&[]).chunks_exact(2))
            .zip(self.row.get(1..).unwrap_or(&[]).chunks_exact(2))
            .zip(self.cotangents)
        {
            if let ([cosines, sines], &[c0, s0], &[c1, s1]) = (sum, first, next) {
                let (c, s) = (c1 - c0, s1 - s0);
                (*cosines, *sines) = (-0.5 * c + cotangent * s, -0.5 * s - cotangent * c);
            }
        }
        let turned_at = self.turned_at.get(depth.wrapping_sub(1)).copied().unwrap_or(0.0);
        Self::phi(columns, half, turned_at as usize, self.start);
        self.branch_sums.spread(self.weighted);
        let gradient = self.gradients.chunks_exact(n).nth(depth.wrapping_sub(1)).unwrap_or(&[]);
        for ((column, start), gradient) in jacobian.chunks_exact_mut(n).zip(self.start.iter()).zip(gradient) {
            for ((j, wave), weighted) in column.iter_mut().zip(self.waves.iter()).zip(self.weighted.iter()) {
                *j += gradient * wave - start * weighted;
            }
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
        let tables = Layout::new(3, 16).unwrap().tables();
        for (place, bit) in (0..HEADER + tables).flat_map(|place| (0..64).map(move |bit| (place, bit))) {
            let mut bad = good.clone();
            bad[place] = f64::from_bits(bad[place].to_bits() ^ (1 << bit));
            assert_eq!(Workspace::new(&mut bad).map(|_| ()), Err(Error::BadWorkspace), "{place} {bit}");
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
