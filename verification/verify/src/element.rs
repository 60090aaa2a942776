//! The element under a varying normal force: its normal law, and steps and tractions along histories.

use crate::call::quiet;
use crate::curve::moved;
use crate::histories;
use crate::sampler::{ElementCase, Sampler, text};
use crate::tally::{At, Tally};
use microslip::element::{Directions, Element, NormalInput};
use microslip::one_direction::tractions::tractions;
use microslip::one_direction::{self as state, Law, OneDirection};
use reference::element::{Element as Exact, Kind, State, Step};
use reference::family::{Family, Given, Size};
use reference::{Input, Real};

/// Rounding errors of neighbouring inputs, in ε.
const UNITS: f64 = 8.0;

/// A share of the largest load of the tables, and its range.
fn share_of_load(sampler: &mut Sampler) -> (f64, &'static str) {
    match sampler.below(8) {
        0 if sampler.chance(0.1) => (sampler.power(-40.0, -9.0), "below the tables"),
        0 => (sampler.power(-9.0, -5.0), "below the tables"),
        1 => (sampler.power(0.0, 6.0), "beyond the tables"),
        2 | 3 => (sampler.power(-6.0, -1.0), "small"),
        4 => (2f64.powi(-(sampler.below(22) as i32)), "powers of 2"),
        _ => (sampler.between(0.1, 1.0), "between"),
    }
}

/// The normal law at random loads and approaches.
pub fn normal_law(case: &ElementCase, sampler: &mut Sampler, tally: &mut Tally) {
    let element = &case.element;
    for _ in 0..25 {
        let (share, range) = share_of_load(sampler);
        let load = share * element.normal_force;
        if element.check_normal_force(load).is_err() {
            continue;
        }
        let approach = at_load(case, load, range, tally);
        if element.check_approach(approach).is_ok() {
            at_approach(case, approach, range, tally);
        }
    }
}

/// The normal law at a load, and its approach.
pub fn at_load(case: &ElementCase, load: f64, range: &'static str, tally: &mut Tally) -> f64 {
    let ElementCase { element, reference, kind, input, .. } = case;
    let at_load = quiet("approach_under", || element.approach_under(load));
    let mut at = tally.at(kind, range, || format!("{} N {load:e}", text(input)));
    let family = &reference.family;
    let exact = family.find(Given::Load, &reference.real(load));
    let [normal, tangential] = family.log_compliances(&exact);
    // S is tabulated, and U less than S by the difference of both K times N.
    let condition = ((normal - tangential).abs() + 1.0) / normal;
    at.check("normal_approach", at_load.value, &exact.approach, condition);
    at.check("normal_compliance", at_load.slope, &exact.normal_compliance, condition);
    let half_width = element.half_width_under(load);
    at.check("normal_half_width", half_width, &exact.half_width, 0.0);
    at_load.value
}

/// The same by an approach.
pub fn at_approach(case: &ElementCase, approach: f64, range: &'static str, tally: &mut Tally) {
    let ElementCase { element, reference, kind, input, .. } = case;
    let family = &reference.family;
    let at_approach = quiet("normal_force_at", || element.normal_force_at(approach));
    let mut at = tally.at(kind, range, || format!("{} w {approach:e}", text(input)));
    let exact = family.find(Given::Approach, &reference.real(approach));
    let [normal, _] = family.log_compliances(&exact);
    let condition = 1.0 / normal;
    at.check("normal_force", at_approach.value, &exact.load, condition);
    let stiffness = 1.0 / &exact.normal_compliance;
    at.check("normal_stiffness", at_approach.slope, &stiffness, condition);
    let half_width = element.half_width_under(at_approach.value);
    at.check("normal_half_width_inverse", half_width, &exact.half_width, condition);
}

/// Steps along a history, and tractions at its end.
pub fn along_a_path(case: &ElementCase, sampler: &mut Sampler, tally: &mut Tally) {
    let kind = [0, 1, 1, 2, 3, 4, 5][sampler.below(7)];
    let (path, range) = (histories::of_element(case, sampler, kind, 32), histories::RANGES[kind]);
    let (state, exact, farthest) = steps(case, &path, range, tally);
    if exact.size.is_some() {
        tractions_at(case, &state, &exact, farthest, sampler, &path, tally);
    }
}

/// Steps along a history: both states at its end, and the largest displacement.
pub fn steps(case: &ElementCase, path: &[[f64; 2]], range: &'static str, tally: &mut Tally) -> (Vec<f64>, State, f64) {
    let ElementCase { element, reference, kind, input } = case;
    let mut library = vec![0.0; state::state_length(64)];
    OneDirection::state_init(&mut library).expect("long enough");
    let mut exact = reference.open();
    // Largest displacement and size so far.
    let (mut farthest, mut largest): (f64, Option<Size>) = (0.0, None);
    for (i, &[u, w]) in path.iter().enumerate() {
        let got = quiet("advance", || OneDirection::step(element, &mut library, [u, w]))
            .unwrap_or_else(|error| panic!("{error:?}: {} path {:?}", text(input), &path[..=i]));
        let before = exact.clone();
        let [displacement, normal] = [u, w].map(|value| reference.real(value));
        let step = reference.step(&mut exact, &displacement, &normal);
        farthest = farthest.max(u.abs());
        if let Some(size) = &exact.size
            && largest.as_ref().is_none_or(|largest| size.load > largest.load)
        {
            largest = Some(size.clone());
        }
        let mut at = tally.at(kind, range, || format!("{} path {:?}", text(input), &path[..=i]));
        let check = Check { case, farthest, before, displacement, normal };
        check.energy(got.dissipated, &step, &exact, &mut at);
        if let (Some(size), Some(largest)) = (&exact.size, &largest) {
            check.forces(got.force, &step, size, largest, &mut at);
            check.tangent(got.tangent, &step, size, &mut at);
        } else {
            assert!(got.force == [0.0; 2] && got.tangent == [0.0; 4], "{}: open, but {got:?}", at.inputs());
        }
    }
    (library, exact, farthest)
}

/// κ of the logarithms of both compliances.
fn soft(family: &Family, size: &Size) -> f64 {
    let [normal, tangential] = family.log_compliances(size);
    1.0 / normal.min(tangential)
}

/// A step of a history, for comparisons.
struct Check<'a> {
    case: &'a ElementCase,
    farthest: f64,
    before: State,
    displacement: Real,
    normal: Real,
}

impl Check<'_> {
    /// Displacements and shifts, which have rounding errors relative to this.
    fn reach(&self, shift: &Real) -> Real {
        self.farthest + &self.case.reference.family.friction * shift
    }

    /// Results of the steps to neighbouring displacements and normal inputs: at a corner the tangent jumps, and so does the slip
    /// zone.
    fn around(&self, size: &Size, result: impl Fn(&Step) -> Real) -> Vec<Real> {
        let units = [-UNITS, 0.0, UNITS].map(|units| units * f64::EPSILON);
        let shifts = units.iter().flat_map(|du| units.iter().map(move |dw| [*du, *dw]));
        let step_to = |[du, dw]: [f64; 2]| {
            let displacement = &self.displacement + du * self.reach(&size.shift);
            let normal = &self.normal * (1.0 + dw);
            result(&self.case.reference.step(&mut self.before.clone(), &displacement, &normal))
        };
        shifts.map(step_to).collect()
    }

    /// κ of the force: displacements and the logarithm of the compliance are rounded.
    fn condition(&self, size: &Size) -> f64 {
        let family = &self.case.reference.family;
        let displacements = self.farthest / (&family.friction * &size.load * &size.tangential_compliance);
        displacements.f64() + soft(family, size)
    }

    fn forces(
        &self,
        [force, load]: [f64; 2],
        step: &Step,
        size: &Size,
        largest: &Size,
        at: &mut At<impl Fn() -> String>,
    ) {
        let friction = &self.case.reference.family.friction;
        let [normal, _] = self.case.reference.family.log_compliances(size);
        at.check("element_normal_force", load, &step.load, 1.0 / normal);
        for (name, size) in [("element_force", largest), ("element_force_present", size)] {
            let scale = friction * &size.load;
            at.check_scaled(name, force, &step.force, &scale, self.condition(size));
        }
    }

    fn tangent(&self, got: [f64; 4], step: &Step, size: &Size, at: &mut At<impl Fn() -> String>) {
        let [by_displacement, normal_by_displacement, by_input, load_slope] = got;
        assert!(normal_by_displacement == 0.0);
        let reference = &self.case.reference;
        let family = &reference.family;
        let [normal, tangential] = family.log_compliances(size);
        let soft = ((normal - tangential).abs() + 1.0) / normal.min(tangential);
        at.check("element_normal_stiffness", load_slope, &step.load_slope, soft);
        // The edge of the slip zone, and the rise of the load, are known to the rounding of displacements and shifts.
        let reach = self.reach(&size.shift);
        let rise = self.before.size.as_ref().map_or(size.shift.clone(), |before| &size.shift - &before.shift);
        let at_edge =
            |edge: &Size, rate: &Real| (family.curvature(edge) * &edge.tangential_compliance * &reach / rate).f64();
        let mut motion = (&self.displacement - &self.before.displacement).abs();
        if self.before.size.is_none() {
            // From where the contact closes on.
            motion = motion * &self.normal / (&self.normal - &self.before.input);
        }
        // Of a rising load, unless all of it slips for sure.
        let secant = rise.is_positive() && motion < &family.friction * &rise + &reach * (64.0 * f64::EPSILON);
        let condition = soft
            + if secant { (&reach / &family.friction / rise).f64() } else { 0.0 }
            + match &step.edge {
                Some((edge, rate)) => at_edge(edge, rate),
                None if step.kind == Kind::GrossSlip || secant => 0.0,
                None => at_edge(size, &family.friction),
            };
        let [exact, exact_by_input] = &step.tangent;
        let stiffness = 1.0 / &size.tangential_compliance;
        let around = |i: usize| self.around(size, |step| step.tangent[i].clone());
        at.check_between("element_stiffness", by_displacement, exact, &stiffness, condition, || around(0));
        let scale = &family.friction * &step.load_slope;
        at.check_between("element_force_by_input", by_input, exact_by_input, &scale, condition, || around(1));
    }

    fn energy(&self, got: f64, step: &Step, exact: &State, at: &mut At<impl Fn() -> String>) {
        let family = &self.case.reference.family;
        assert!(got >= 0.0, "{}: dissipated {got:e}", at.inputs());
        // The larger one of both sizes, whose slip zone slips by a difference of displacements and shifts.
        let sizes = [&self.before.size, &exact.size];
        let Some(size) =
            sizes.into_iter().flatten().max_by(|one, two| one.load.partial_cmp(&two.load).expect("numbers"))
        else {
            return;
        };
        let zone = &family.friction * (&size.load - &step.stick_load);
        let rounding = zone * self.reach(&size.shift);
        let scale = &step.dissipated + &rounding;
        let condition = 3.0 * soft(family, size);
        let around = || self.around(size, |step| step.dissipated.clone());
        at.check_between("element_dissipated", got, &step.dissipated, &scale, condition, around);
    }
}

fn tractions_at(
    case: &ElementCase,
    library: &[f64],
    exact: &State,
    farthest: f64,
    sampler: &mut Sampler,
    path: &[[f64; 2]],
    tally: &mut Tally,
) {
    let ElementCase { element, reference, kind, input } = case;
    let family = &reference.family;
    let size = exact.size.as_ref().expect("closed");
    let half_width = size.half_width.f64();
    let x: Vec<f64> = (0..8).map(|_| half_width * sampler.between(-1.0, 1.0)).collect();
    let (mut pressure, mut shear) = (vec![f64::NAN; x.len()], vec![f64::NAN; x.len()]);
    quiet("tractions", || tractions(element, library, &x, Some(&mut pressure), Some(&mut shear))).expect("a state");
    let peak = &family.friction * family.pressure(size, &reference.real(0.0));
    for ((&x, pressure), shear) in x.iter().zip(pressure).zip(shear) {
        let mut at = tally.at(kind, "any history", || format!("{} path {path:?} x {x:e}", text(input)));
        let spot = reference.real(x).abs();
        let [exact_pressure, exact_shear] = reference.tractions(exact, &spot);
        let gap = |edge: &Real| (edge / (&spot - edge)).abs().f64();
        let soft = soft(family, size);
        let at_edge = gap(&size.half_width) * (1.0 + soft);
        let corners = || [-UNITS, UNITS].map(|units| family.pressure(size, &(&spot * moved(1.0, units)))).into();
        at.check_between("element_pressure", pressure, &exact_pressure, &exact_pressure, at_edge, corners);
        // Each knot is known to the rounding of displacements and shifts, over the change of D.
        let reach = farthest / &family.friction + &size.shift;
        let mut condition = at_edge + soft + (&reach / &size.shift).f64();
        for pair in exact.pieces.windows(2) {
            let edge = &pair[0].end;
            condition += gap(&edge.half_width) * (1.0 + (&reach / (&edge.load * &edge.tangential_compliance)).f64());
        }
        at.check_scaled("element_shear", shear, &exact_shear, &peak, condition);
    }
}

/// The library's element, if it accepts it.
pub fn make(input: &Input, directions: Directions, normal: NormalInput) -> Option<Element> {
    let element = quiet("element", || match input {
        Input::Flat(parameters) => Element::rounded_flat(parameters, directions, normal),
        Input::Ellipse(parameters) => Element::elliptic(parameters, directions, normal),
    });
    element.ok()
}

/// The element of one direction, and the same in multi-precision.
pub fn prepare(input: &Input, by_force: bool) -> Option<(Element, Exact)> {
    let normal = if by_force { NormalInput::Force } else { NormalInput::Approach };
    make(input, Directions::One, normal).map(|element| (element, Exact::new(input, by_force)))
}
