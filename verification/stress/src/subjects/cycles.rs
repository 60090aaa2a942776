//! A hundred million cycles: the force at the end of each, and the state, are those of the first, to the bit.

use crate::contacts::Named;
use crate::library::State;
use crate::{Case, Outcome, Run, contacts, ensure};
use rand::Rng;

/// Cycles between two comparisons of the state, and reports of progress.
const BATCH: u64 = 100_000;

/// Minor loops between the ends of a cycle.
#[derive(Debug, Clone, Copy)]
enum Inner {
    Nothing,
    /// The same loop in each half, and one in it.
    Loops,
    /// Two random reversals in each half.
    Random,
}

pub fn cases(cycles: u64) -> Vec<Case> {
    let contacts = contacts::all();
    let of = |name: &str| contacts.iter().find(|contact| contact.name == name).expect("a contact of that name").clone();
    let mut cases = vec![
        cycling(of("cylinder"), 0.7, Inner::Nothing, cycles),
        cycling(of("flat, a/b = 0.95"), 1.5, Inner::Nothing, cycles),
        cycling(of("ellipse 1:3"), 0.4, Inner::Loops, cycles),
        cycling(of("flat, a/b = 0.3"), 0.9, Inner::Random, cycles),
    ];
    for contact in &contacts {
        for (amplitude, inner) in [(1e-9, Inner::Random), (1.0, Inner::Loops), (3.0, Inner::Random)] {
            cases.push(cycling(contact.clone(), amplitude, inner, cycles / 100));
        }
        cases.push(ratchet(contact.clone(), cycles / 100));
    }
    cases
}

fn cycling(named: Named, amplitude: f64, inner: Inner, cycles: u64) -> Case {
    let name = format!("cycles: {}: amplitude {amplitude} of gross slip, {inner:?}", named.name);
    Case::new(name, cycles, move |run| {
        let contact = &named.contact;
        let end = amplitude * contact.slip();
        let mut state = State::new(8);
        // Initial loading, and one cycle to the steady state.
        for displacement in [end, -end] {
            state.force_after(contact, displacement)?;
        }
        let top = state.force_after(contact, end)?;
        let steady = state.bits();
        let bottom = state.force_at(contact, -end)?;
        for number in 1..=cycles {
            for (side, force) in [(-1.0, bottom), (1.0, top)] {
                for displacement in reversals(inner, side, run).map(|share| share * end) {
                    state.force_after(contact, displacement)?;
                }
                let there = state.force_after(contact, side * end)?;
                ensure!(
                    there == force,
                    "cycle {number}: {there:?} at {:?}, at first {force:?}\n  {contact:?}",
                    side * end
                );
            }
            if number % BATCH == 0 || number == cycles {
                ensure!(state.bits() == steady, "cycle {number} gives the state {:?}\n  {contact:?}", state.used());
                run.done(if number % BATCH == 0 { BATCH } else { cycles % BATCH });
            }
        }
        Ok(format!("{top:?} N at {end:?} m"))
    })
}

/// Reversals of a half cycle towards `side`, over its amplitude.
fn reversals(inner: Inner, side: f64, run: &mut Run) -> impl Iterator<Item = f64> + use<> {
    let (reversals, count) = match inner {
        Inner::Nothing => ([0.0; 4], 0),
        Inner::Loops => ([0.5 * side, -0.4 * side, 0.3 * side, -0.2 * side], 4),
        Inner::Random => {
            let [one, two]: [f64; 2] = [run.rng.random(), run.rng.random()];
            let there = 2.0 * one - 1.0;
            ([side * there, side * (there - two * (there + 1.0)), 0.0, 0.0], 2)
        }
    };
    reversals.into_iter().take(count)
}

/// Cycles with gross slip in one direction, up to a billion times the displacement of gross slip: the loop is the same to the bit
/// everywhere. Displacements are multiples of a power of 2, so that their differences are exact.
fn ratchet(named: Named, cycles: u64) -> Case {
    Case::new(format!("cycles: {}: ratchet", named.name), cycles, move |run| {
        let contact = &named.contact;
        // A unit below a hundredth of gross slip: 2^50 of them are as far as 1e13 times gross slip.
        let unit = 2f64.powi((0.01 * contact.slip()).log2().floor() as i32);
        let units = |share: f64| (share * contact.slip() / unit).round();
        let (back, inner, on) = (units(1.6), units(0.7), units(2.0));
        let mut state = State::new(8);
        state.force_after(contact, 10.0 * on * unit)?;
        let mut end = 10.0 * on;
        let mut first = None;
        for number in 1..=cycles {
            // By growing steps of whole units.
            end += on + (number % 997 * number) as f64;
            let mut forces = [0.0; 5];
            let places = [end, end - back, end - inner, end - back + 1.0, end - 1.0];
            for (force, place) in forces.iter_mut().zip(places) {
                *force = state.force_after(contact, place * unit)?;
            }
            let first = *first.get_or_insert(forces);
            ensure!(
                forces == first,
                "cycle {number} at {:?}: {forces:?}, at first {first:?}\n  {contact:?}",
                end * unit
            );
            if number % BATCH == 0 || number == cycles {
                run.done(if number % BATCH == 0 { BATCH } else { cycles % BATCH });
            }
        }
        bounded(end)?;
        Ok(format!("as far as {:.0e} times gross slip", end * unit / contact.slip()))
    })
}

/// Beyond 2^53 units differences would be rounded.
fn bounded(units: f64) -> Outcome {
    ensure!(units < 2f64.powi(53), "{units} units are too many");
    Ok(())
}
