//! The state of an element with two directions in the caller's memory, and a step of it.
//!
//! ```text
//! [tag, v, u, normal component, key of the element, units of the springs (3), springs under the flat, last shell and part,
//!  N | the normal state in the units of the springs and its derivatives (7 each), stiffnesses at the edge (2), force of the springs (2),
//!  derivative of N, a double that needs 17 digits | rows of the edge | turned | C⁻¹ | springs | tables]
//! ```
//!
//! in rows of as many doubles as springs. The tables are aligned with a load: the state carries them, as they change with its history only.
//! Present loads down to a part of the aligned one are as accurate, and derivatives of a step need none of the alignment. A contact that
//! opens has the state of a new one.

use super::contact::{Contact, Pressed};
use super::path::{LONGEST, Path};
use super::scalar::{Dual, Linear};
use super::slip::Slips;
use super::step::{advance, bounded, derivatives, separated};
use super::stick;
use super::tables::{Both, DualRows, END, FINE, Matrix, N, ROWS, Row, Rows, Units, fill, starts, under_flat};
use super::trial::{Derivatives, FINE_SPRING, LEAST, Motion, SPRINGS, Values, trial};
use super::{Requested, Step, TwoDirections};
use crate::element::{Directions, Element, Normal};
use crate::error::Error;
use crate::law::{Law, PathOutput};
use crate::limits::check_displacement;
use crate::numerics::fp_class::is_finite;
use crate::shape::TINY;
use crate::tag::Kind;

/// The springs are aligned with powers of this ratio times the normal force of the parameters, and anew from a load over it by the second
/// ratio on. Both must differ by more than rounding.
const LEVEL: f64 = 1.03;
const OUTGROWN: f64 = 1.02;
/// The least power: below, loads are aligned with the least reference load.
const LEAST_LEVEL: f64 = -300.0;

/// Decimal text of 16 significant digits or fewer changes this double, which is halfway between two numbers of 16 digits: the state of a
/// closed contact is rejected then. Its springs at the edge are so stiff that rounding errors of their limits would be amplified.
const ALL_DIGITS: f64 = 1_000.000_000_000_000_5;

const HEADER_ROWS: usize = 3;
const EDGE_ROWS: usize = 5;
const TURNED_ROWS: usize = 2;
const INVERSE_ROWS: usize = 2 * N;
const STATE_ROWS: usize = HEADER_ROWS + EDGE_ROWS + TURNED_ROWS + INVERSE_ROWS + SPRINGS / N + ROWS;
pub(super) const LENGTH: usize = N * STATE_ROWS;

impl Law for TwoDirections {
    type Item = Element;
    type Vector = [f64; 3];
    type Tangent = [f64; 9];

    const STATE_LENGTH: usize = LENGTH;
    const STATE: Kind = Kind::TwoDirectionsState;
    const OTHER_STATE: Option<Kind> = Some(Kind::ElementState);

    #[inline(always)]
    fn check(element: &Element) -> Result<(), Error> {
        element.check_directions(Directions::Two)
    }

    #[inline(always)]
    fn check_step(element: &Element, &[u, v, input]: &[f64; 3]) -> Result<(), Error> {
        check_displacement(u)?;
        check_displacement(v)?;
        element.check_normal(element.by_approach(), input)
    }

    fn state_check(state: &[f64]) -> Result<(), Error> {
        TwoDirections::check_header(state)?;
        let mut copy = [0.0; LENGTH];
        Self::copy_used(state, &mut copy);
        let Some(memory) = Memory::of(&mut copy) else { return Err(Error::StateTooShort) };
        if !state.iter().take(LENGTH).all(|value| is_finite(*value)) {
            return Err(Error::BadState);
        }
        let (header, contact) = (memory.header(), memory.contact());
        if header.normal_force == 0.0 {
            return Ok(());
        }
        let Units { load, shift, size } = header.units;
        let positive =
            [header.normal_force, load, shift, size, contact.now.load, contact.now.shift[0], contact.now.shift[1]];
        let mut held = memory.springs.as_flattened().iter().chain(memory.turned.as_flattened());
        let held = held.all(|value| value.abs() <= LONGEST);
        let edge = contact.edge.as_flattened().iter().chain(&contact.per_pressure).all(|value| *value >= 0.0);
        // Products of derivatives do not overflow.
        let small = contact.slopes.values().iter().all(|slope| slope.abs() <= 1.0 / LEAST);
        let start = starts(contact.under_flat);
        let within = (0..2).all(|k| {
            let rounding = 1e-9 * contact.now.shift[k];
            let limit = |start: usize| contact.limit(&&*memory.tables, k, start) + rounding;
            let mut springs = memory.springs[k].iter().zip(start).take(contact.last + 1);
            springs.all(|(spring, start)| spring.abs() <= limit(*start))
        });
        let [.., [.., all_digits, _, _, _, _]] = *memory.header;
        if all_digits == ALL_DIGITS && within && held && edge && small && positive.iter().all(|value| *value > 0.0) {
            Ok(())
        } else {
            Err(Error::BadState)
        }
    }

    #[inline(always)]
    fn trial(element: &Element, old: &[f64], displacement: [f64; 3], requested: Requested) -> Step {
        let mut copy = [0.0; LENGTH];
        Self::copy_used(old, &mut copy);
        Self::advance(element, &mut copy, displacement, requested)
    }

    fn advance(element: &Element, state: &mut [f64], to: [f64; 3], requested: Requested) -> Step {
        let closes = element.is_closed(to[2]);
        let mut result = Step::NONE;
        let Some(mut memory) = Memory::of(state) else { return result };
        let (mut header, mut from) = (memory.header(), memory.contact());
        if element.friction_coefficient == 0.0 || !(closes || header.normal_force > 0.0) {
            // Without friction, or open before and after, only the position changes.
            if closes {
                let normal = element.normal(to[2]);
                (result.force[2], result.tangent[8]) = (normal.load, normal.load_slope);
            }
            memory.open(to);
            return result;
        }
        let belongs = header.key == element.key;
        let same =
            belongs && closes && header.normal_force > 0.0 && to[2].to_bits() == header.displacement[2].to_bits();
        let normal = if closes && !same {
            element.normal(to[2])
        } else {
            Normal { load: header.normal_force, load_slope: header.load_slope, ..Normal::OPEN }
        };
        let largest = header.normal_force.max(normal.load);
        if !belongs || (!same && largest > OUTGROWN * header.units.load) {
            memory.align(element, &mut header, &mut from, largest);
        }
        let was_closed = header.normal_force > 0.0;
        let path = Path::new(element, &header.units, [header.displacement, to], [was_closed, closes]);
        if closes {
            return memory.step(&header, &from, &path, &End { element, to, normal, same, requested });
        }
        if requested.energy {
            let energy = separated(memory.tables, &from, &Pressed::default(), path.by, memory.springs);
            result.dissipated = header.outputs(element, &path)[1] * energy;
        }
        memory.open(to);
        result
    }

    #[inline(never)]
    fn path_in_copy(element: &Element, state: &[f64], path: &[[f64; 3]], output: PathOutput<Self>) {
        let mut copy = [0.0; LENGTH];
        Self::copy_used(state, &mut copy);
        Self::path(element, &mut copy, path, output);
    }
}

/// Where a contact is, and its alignment; open if the normal force is 0.
#[derive(Debug, Clone, Copy)]
struct Header {
    displacement: [f64; 3],
    normal_force: f64,
    load_slope: f64,
    /// Of the element whose tables these are.
    key: f64,
    units: Units,
    /// Of the springs, in their units.
    force: Both<f64>,
}

impl Header {
    /// The units of forces and energies of a step.
    #[inline(always)]
    fn outputs(&self, element: &Element, path: &Path) -> [f64; 2] {
        let force = element.friction_coefficient * self.units.load;
        [force, force * element.friction_coefficient * self.units.shift * path.scale]
    }
}

/// The end of a step of a contact that is closed then, whether under the load of the start, and what is requested of it.
struct End<'a> {
    element: &'a Element,
    to: [f64; 3],
    normal: Normal,
    same: bool,
    requested: Requested,
}

/// The parts of a state.
struct Memory<'a> {
    header: &'a mut [Row<f64>; HEADER_ROWS],
    edge: &'a mut [Row<f64>; EDGE_ROWS],
    turned: &'a mut Both<Row<f64>>,
    inverse: &'a mut Both<Matrix>,
    springs: &'a mut Values,
    tables: &'a mut Rows,
}

impl Memory<'_> {
    #[inline(always)]
    fn of(state: &mut [f64]) -> Option<Memory<'_>> {
        let (header, rest) = state.as_chunks_mut::<N>().0.split_first_chunk_mut()?;
        let (edge, rest) = rest.split_first_chunk_mut()?;
        let (turned, rest) = rest.split_first_chunk_mut()?;
        let (inverse, rest) = rest.split_at_mut_checked(INVERSE_ROWS)?;
        let (springs, rest) = rest.split_first_chunk_mut()?;
        let inverse = inverse.as_chunks_mut::<N>().0.first_chunk_mut()?;
        Some(Memory { header, edge, turned, inverse, springs, tables: rest.first_chunk_mut()? })
    }

    #[inline(always)]
    fn header(&self) -> Header {
        let [[_, v, u, input, key, load, shift, size, _, _, _, normal_force], [.., x, y, load_slope], _] = *self.header;
        let units = Units { load, shift, size };
        Header { displacement: [u, v, input], normal_force, load_slope, key, units, force: [x, y] }
    }

    #[inline(always)]
    fn contact(&self) -> Contact<f64> {
        let [[.., flat, last, part, _], [now @ .., w_x, w_y, _, _, _], [slopes @ .., _, _, _, _, _]] = *self.header;
        let [edge_x, edge_y, per_pressure, fine_x, fine_y] = *self.edge;
        let under_flat = if flat > 0.0 { 2 } else { 0 };
        // Counts from outside the process may be too large.
        let last = (last as usize).clamp(under_flat, N - 1);
        let part = (part as usize).min(FINE - 1);
        Contact {
            edge: [edge_x, edge_y],
            pressure: [0.0; N],
            per_pressure,
            stiffness: [w_x, w_y],
            fine: [fine_x, fine_y],
            now: Pressed::of(now),
            slopes: Pressed::of(slopes),
            last,
            part,
            first_part: starts(under_flat)[last],
            under_flat,
        }
    }

    #[inline(always)]
    fn write(&mut self, header: &Header, contact: &Contact<f64>) {
        let Header { displacement: [u, v, input], normal_force, load_slope, key, units, force } = *header;
        let Units { load, shift, size } = units;
        let [flat, last, part] = [contact.under_flat, contact.last, contact.part].map(|count| count as f64);
        let tag = Kind::TwoDirectionsState.tag();
        let [[a, b, c, d, e, f, g], [p, q, r, s, t, w, x]] = [contact.now, contact.slopes].map(Pressed::values);
        let [w_x, w_y] = contact.stiffness;
        *self.header = [
            [tag, v, u, input, key, load, shift, size, flat, last, part, normal_force],
            [a, b, c, d, e, f, g, w_x, w_y, force[0], force[1], load_slope],
            [p, q, r, s, t, w, x, ALL_DIGITS, 0.0, 0.0, 0.0, 0.0],
        ];
        let ([edge_x, edge_y], [fine_x, fine_y]) = (contact.edge, contact.fine);
        *self.edge = [edge_x, edge_y, contact.per_pressure, fine_x, fine_y];
    }

    /// A step from a contact to one that is closed.
    #[inline(always)]
    fn step(&mut self, header: &Header, from: &Contact<f64>, path: &Path, end: &End) -> Step {
        let &End { element, to, normal, same, requested } = end;
        let mut contact = from;
        let pressed;
        if !same {
            let now = Pressed::new(element, &header.units, to[2], &normal);
            pressed = Contact::press(self.tables, &now, from.under_flat, self.inverse);
            contact = &pressed;
        }
        let motion = Motion { before: from.now.shift, by: path.by, constant_load: same };
        let [unit, energy_unit] = header.outputs(element, path);
        let trial = trial(self.tables, contact, &motion, self.springs);
        let mut force = header.force;
        let sticks = same && trial.sticks;
        let at_edge = sticks.then(|| stick::stick(self.tables, contact, &path.by, self.springs, &mut force)).flatten();
        let (mut tangent, mut energy) = ([[0.0; 4]; 2], 0.0);
        if let Some(edge) = at_edge {
            if requested.tangent {
                tangent = stick::tangent(self.tables, contact, &edge, self.springs);
            }
            self.move_to(to, &force);
        } else {
            let mut slip = Slips { trial, turned: *self.turned, ..Slips::default() };
            slip.find(self.tables, contact, self.inverse, &motion, self.springs, requested.tangent);
            if requested.tangent {
                tangent = self.tangent(contact, (path, &motion), &slip);
            }
            (force, energy) = advance(self.tables, [from, contact], &motion, &slip, requested.energy, self.springs);
            *self.turned = slip.turned;
            let Normal { load: normal_force, load_slope, .. } = normal;
            self.write(&Header { displacement: to, normal_force, load_slope, force, ..*header }, contact);
        }
        force = bounded(force, contact.now.load);
        let mut result = Step { force: [unit * force[0], unit * force[1], normal.load], ..Step::NONE };
        if requested.tangent {
            let units = [unit * path.per_distance, unit / element.input_scale()];
            result.tangent = tangent_of(tangent, units, normal.load_slope);
        }
        result.dissipated = energy_unit * energy;
        result
    }

    /// Derivatives of the force of a step that slips: by the normal component and by both displacements of the springs.
    #[inline(never)]
    fn tangent(
        &self,
        contact: &Contact<f64>,
        (path, motion): (&Path, &Motion<f64, f64>),
        slip: &Slips,
    ) -> Both<[f64; 4]> {
        let by = [0, 1].map(|k| {
            let mut by = Dual::constant(motion.by[k]);
            (by.0[0][END], by.0[0][END + 1 + k]) = (path.per_input[k][1], 1.0);
            by
        });
        let constant_load = motion.constant_load;
        let motion = Motion { before: motion.before.map(Dual::constant), by, constant_load };
        let rows = DualRows::without_slopes(self.tables);
        let contact = contact.derived(&rows, true);
        let mut springs = Derivatives { values: self.springs, slopes: &mut [] };
        let force = derivatives(&rows, (&contact, self.inverse), &motion, slip, &mut springs);
        bounded(force, contact.now.load).map(|force| force.0[0])
    }

    /// The state of a new contact, at a place.
    fn open(&mut self, [u, v, input]: [f64; 3]) {
        let [_, _, _, _, key, ..] = self.header[0];
        if key != 0.0 {
            (*self.edge, *self.turned) = ([[0.0; N]; EDGE_ROWS], [[0.0; N]; TURNED_ROWS]);
            *self.springs = [[0.0; N]; SPRINGS / N];
            (*self.inverse, *self.tables) = ([[[0.0; N]; N]; 2], [[0.0; N]; ROWS]);
            *self.header = [[0.0; N]; HEADER_ROWS];
        }
        let tag = Kind::TwoDirectionsState.tag();
        [self.header[0][0], self.header[0][1], self.header[0][2], self.header[0][3]] = [tag, v, u, input];
    }

    /// The place of a state in which nothing slipped.
    fn move_to(&mut self, [u, v, _]: [f64; 3], force: &Both<f64>) {
        let [[_, v_place, u_place, ..], [.., x, y, _], _] = &mut *self.header;
        (*v_place, *u_place, *x, *y) = (v, u, force[0], force[1]);
    }

    /// Aligns the springs with a load. Those of another element are relaxed.
    #[inline(never)]
    fn align(&mut self, element: &Element, header: &mut Header, contact: &mut Contact<f64>, load: f64) {
        let level = ((load / (OUTGROWN * element.normal_force)).ln() / LEVEL.ln()).ceil().max(LEAST_LEVEL);
        let load = element.normal_force * (level * LEVEL.ln()).exp();
        let units = Units::of(element, load.min(element.largest_load));
        let inner = under_flat(element, &units);
        let (belongs, ratio) = (header.key == element.key, header.units.shift / units.shift);
        let (old, old_tables) = (*self.springs, *self.tables);
        (header.key, header.units) = (element.key, units);
        fill(self.tables, element, &units, 1.0);
        *self.springs = [[0.0; N]; SPRINGS / N];
        let from = core::mem::replace(contact, Contact { under_flat: inner, ..Contact::default() });
        if !element.is_closed(header.displacement[2]) || header.normal_force <= 0.0 {
            header.normal_force = 0.0;
            return;
        }
        let input = header.displacement[2];
        let now = Pressed::new(element, &units, input, &element.normal(input));
        *contact = Contact::press(self.tables, &now, inner, self.inverse);
        if belongs {
            transfer([&old_tables, self.tables], [&from, contact], ratio, &old, self.springs);
        }
    }
}

/// Springs of another alignment, whose unit of S is the given part: their displacements, as functions of the distance to the edge, are
/// polygons with the nodes as corners.
fn transfer(
    [old_tables, tables]: [&Rows; 2],
    [from, to]: [&Contact<f64>; 2],
    ratio: f64,
    old: &Values,
    new: &mut Values,
) {
    let [start, to_start] = [from, to].map(|contact| starts(contact.under_flat));
    for k in 0..2 {
        let fine_at = |f: usize| old.as_flattened().get(FINE_SPRING + k * FINE + f).copied().unwrap_or(0.0);
        let fine = |limit: f64| {
            polygon(limit / ratio, (0..=from.part).rev().map(|f| [from.limit(&old_tables, k, f), fine_at(f)])) * ratio
        };
        let own = |j: usize| [from.limit(&old_tables, k, start[j]), old[k][j] - fine_at(start[j])];
        for (f, place) in new.as_flattened_mut().iter_mut().skip(FINE_SPRING + k * FINE).take(to.part + 1).enumerate() {
            *place = fine(to.limit(&tables, k, f));
        }
        for j in 0..=to.last.min(N - 1) {
            let limit = to.limit(&tables, k, to_start[j]);
            let corners = (from.under_flat..=from.last).rev().map(|j| own(j.min(N - 1)));
            let inner = j < from.under_flat && j < to.under_flat;
            new[k][j] = if inner { ratio * old[k][j] } else { fine(limit) + ratio * polygon(limit / ratio, corners) };
        }
    }
}

/// The value at an abscissa of a polygon that begins at (0, 0).
fn polygon(at: f64, corners: impl Iterator<Item = [f64; 2]>) -> f64 {
    let mut before = [0.0; 2];
    for corner in corners {
        if corner[0] >= at {
            let width = (corner[0] - before[0]).max(TINY);
            return before[1] + (at - before[0]) / width * (corner[1] - before[1]);
        }
        before = corner;
    }
    before[1]
}

/// The tangent from the derivatives of both forces by the normal component, u and v, in the units of the springs.
fn tangent_of(slopes: Both<[f64; 4]>, [per_distance, per_input]: [f64; 2], load_slope: f64) -> [f64; 9] {
    let [[w_x, x_x, x_y, _], [w_y, y_x, y_y, _]] = slopes;
    let [xx, yx, xy, yy] = [x_x, y_x, x_y, y_y].map(|slope| per_distance * slope);
    [xx, yx, 0.0, xy, yy, 0.0, per_input * w_x, per_input * w_y, load_slope]
}
