//! Energy: closed loops dissipate the cycle energy of the interface, and the area that they enclose.

use crate::contacts::Named;
use crate::histories::divided;
use crate::library::{BRANCH_ROUNDING, Contact, State};
use crate::memory::{Memory, Point};
use crate::{Case, contacts, ensure};
use quadrature::double_exponential::integrate;
use rand::Rng;

pub fn cases(loops: u64) -> Vec<Case> {
    let mut cases = Vec::new();
    for contact in contacts::all() {
        cases.push(symmetric(contact.clone(), loops));
        cases.push(minor(contact, loops));
    }
    cases
}

/// Work of a step, by quadrature of the force between the ends of branches.
fn work(contact: &Contact, state: &State, memory: &Memory, displacement: f64) -> Result<f64, String> {
    let from = memory.now().displacement;
    let direction = (displacement - from).signum();
    let ahead = |place: &f64| direction * (place - from) > 0.0 && direction * (displacement - place) > 0.0;
    let first = memory.points[0].displacement;
    // Branches end at reversals, at the mirror point of the first, and where gross slip starts.
    let slip = contact.slip();
    let starts = if memory.slip_direction == 0.0 {
        [-first, direction * slip]
    } else {
        [first - memory.slip_direction * 2.0 * slip; 2]
    };
    let reversals = memory.points.iter().map(|point| point.displacement);
    let mut places: Vec<f64> = reversals.chain(starts).filter(ahead).chain([displacement]).collect();
    places.sort_by(|a, b| (direction * a).total_cmp(&(direction * b)));
    let mut sum = 0.0;
    let mut start = from;
    for end in places {
        // The rule has dense nodes at both ends, where the stiffness may be singular.
        let length = (end - start).abs();
        let force = |distance: f64| state.force_at(contact, start + direction * distance).unwrap_or(f64::NAN);
        if length > 0.0 {
            sum += direction * integrate(force, 0.0, length, 1e-16 * contact.slip_force() * length).integral;
        }
        start = end;
    }
    Ok(sum)
}

/// Loops between -A and +A, of a part in a million of gross slip up to a hundred times as far, in parts of any size.
fn symmetric(named: Named, loops: u64) -> Case {
    Case::new(format!("loops: {}: about the origin", named.name), loops, move |run| {
        let contact = &named.contact;
        let (mut worst, mut worst_area) = (0.0_f64, 0.0_f64);
        for number in 0..loops {
            let share = match number % 4 {
                0 => 10f64.powf(run.rng.random_range(-6.0..0.0)),
                1 => 1.0 - 10f64.powf(run.rng.random_range(-8.0..0.0)),
                2 => 1.0 + 10f64.powf(run.rng.random_range(-8.0..2.0)),
                _ => run.rng.random_range(0.0..1.0),
            };
            let end = share * contact.slip();
            let (expected, rounding) = contact.cycle_energy(end)?;
            let (mut state, mut memory) = (State::new(4), Memory::new(contact.slip()));
            go(contact, &mut state, &mut memory, end)?;
            let (mut sum, mut area) = (0.0, 0.0);
            for side in [-1.0, 1.0] {
                area += work(contact, &state, &memory, side * end)?;
                let parts = run.rng.random_range(1..30);
                for displacement in divided(-side * end, side * end, parts, &mut run.rng) {
                    sum += go(contact, &mut state, &mut memory, displacement)?;
                }
            }
            // The energies of steps are differences of those of cycles and telescope; energies have errors of at most 1e-13.
            let error = (sum - expected).abs() / (expected + 1e13 * rounding);
            worst = worst.max(error);
            ensure!(error <= 1e-13, "amplitude {end:?}: {sum:?} dissipated, {expected:?} in a cycle\n  {contact:?}");
            let error = (area - sum).abs() / (4.0 * contact.slip_force() * end);
            worst_area = worst_area.max(error);
            ensure!(error <= AREA, "amplitude {end:?}: the area is {area:?}, dissipated {sum:?}\n  {contact:?}");
            run.done(1);
        }
        Ok(format!("worst {worst:.0e} of the energy, {worst_area:.0e} of the area"))
    })
}

/// Error of an area over mu N times the length of its path: the weights of the rule have thirteen digits.
const AREA: f64 = 3e-13;

/// Minor loops on a branch, with loops in them, back to their start: the state is as before, and the work is dissipated.
fn minor(named: Named, loops: u64) -> Case {
    Case::new(format!("loops: {}: minor loops", named.name), loops, move |run| {
        let contact = &named.contact;
        let mut worst = 0.0_f64;
        for _ in 0..loops {
            let (mut state, mut memory) = (State::new(64), Memory::new(contact.slip()));
            for _ in 0..run.rng.random_range(1..6) {
                let displacement = run.rng.random_range(-1.5..1.5) * contact.slip();
                go(contact, &mut state, &mut memory, displacement)?;
            }
            let here = memory.now();
            // Towards the start of this branch, but not as far.
            let distance = match &memory.points[..] {
                [.., before, _] => before.displacement - here.displacement,
                _ => -here.displacement.clamp(-contact.slip(), contact.slip()),
            };
            let before = state.clone();
            let (mut sum, mut area, mut path) = (0.0, 0.0, 0.0);
            for number in (0..run.rng.random_range(2..12)).rev() {
                let share = if number == 0 { 0.0 } else { run.rng.random_range(0.0..0.95) };
                let displacement = if number == 0 { here.displacement } else { here.displacement + share * distance };
                area += work(contact, &state, &memory, displacement)?;
                path += (displacement - memory.now().displacement).abs();
                sum += go(contact, &mut state, &mut memory, displacement)?;
            }
            ensure!(
                state.bits() == before.bits(),
                "a loop from {:?} gives the state {:?}\n  {contact:?}",
                before.used(),
                state.used()
            );
            let rounding = 20.0 * BRANCH_ROUNDING * contact.slip_energy();
            let error = (area - sum).abs() / (contact.slip_force() * path + rounding);
            worst = worst.max(error);
            ensure!(
                error <= AREA,
                "a loop from {:?}: the area is {area:?}, dissipated {sum:?}\n  {contact:?}",
                before.used()
            );
            run.done(1);
        }
        Ok(format!("worst {worst:.0e} of mu N times the path"))
    })
}

/// One step, and the energy it dissipates.
fn go(contact: &Contact, state: &mut State, memory: &mut Memory, displacement: f64) -> Result<f64, String> {
    let response = state.step(contact, displacement)?;
    memory.visit(Point { displacement, force: response.force }, state.slips());
    Ok(response.dissipated)
}
