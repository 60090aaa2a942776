//! States of every size: the force differs from that of a state that holds all reversals by no more than the reported error, and
//! by nothing while no reversals were merged.

use crate::contacts::Named;
use crate::library::{BRANCH_ROUNDING, Contact, Response, State, path};
use crate::{Case, contacts, ensure};
use rand::Rng;
use rand_chacha::ChaCha8Rng;

pub fn cases(spirals: u64, deep: usize) -> Vec<Case> {
    let mut cases: Vec<Case> = contacts::all().into_iter().map(|contact| full(contact, spirals)).collect();
    let mut contacts = contacts::all();
    contacts.truncate(2);
    cases.extend(contacts.into_iter().map(|contact| deeply_nested(contact, deep)));
    cases
}

/// Nested loops of decreasing size, then random displacements, which close some of them and open others.
fn history(contact: &Contact, reversals: usize, ratio: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let spiral = (0..reversals as i32).map(|i| 0.95 * ratio.powi(i) * f64::from(1 - 2 * (i % 2)));
    let scattered = (0..reversals).map(|_| rng.random_range(-1.0..1.0));
    spiral.chain(scattered).map(|share| share * contact.slip()).collect()
}

fn full(named: Named, histories: u64) -> Case {
    Case::new(format!("capacity: {}: full states", named.name), histories, move |run| {
        let contact = &named.contact;
        let mut worst = 0.0_f64;
        for _ in 0..histories {
            let capacity = run.rng.random_range(2..24);
            let reversals = capacity + run.rng.random_range(2..10);
            let ratio = [0.999, 0.9, 0.5, 0.02][run.rng.random_range(0..4)];
            let history = history(contact, reversals, ratio, &mut run.rng);
            worst = bounded(contact, capacity, &history)
                .map_err(|failure| format!("{failure}\n  capacity {capacity}, path {history:?}\n  {contact:?}"))?
                .max(worst);
            run.done(1);
        }
        Ok(format!("reported error up to {worst:.0e} of mu N"))
    })
}

/// The same history in a short and a long state; the largest reported error over mu N.
fn bounded(contact: &Contact, capacity: usize, history: &[f64]) -> Result<f64, String> {
    let (mut short, mut long) = (State::new(capacity), State::new(history.len()));
    let (mut error, mut worst) = (0.0, 0.0_f64);
    let mut forces = Vec::new();
    for displacement in history {
        let [found, exact] = [&mut short, &mut long].map(|state| state.step(contact, *displacement));
        let (found, exact) = (found?, exact?);
        let before = std::mem::replace(&mut error, short.error());
        let difference = (found.force - exact.force).abs();
        ensure!(error > 0.0 || difference == 0.0, "nothing was merged: {found:?}, {exact:?}");
        ensure!(before.max(error) > 0.0 || found == exact, "nothing was merged: {found:?}, {exact:?}");
        let rounding = BRANCH_ROUNDING * contact.slip_force();
        ensure!(difference <= error + rounding, "{difference:?} off, {error:?} reported, at {displacement:?}");
        worst = worst.max(error / contact.slip_force());
        forces.push(found.force);
    }
    ensure!(long.error() == 0.0, "an error in a state that holds all reversals");
    // In one call.
    for kept in [true, false] {
        let mut state = State::new(capacity);
        let outputs = path(contact, &mut state, history, [true, false, false], kept)?;
        ensure!(outputs[0].as_ref() == Some(&forces), "in one call: {outputs:?}, step by step {forces:?}");
        ensure!(!kept || state.bits() == short.bits(), "in one call: {:?}, {:?}", state.used(), short.used());
    }
    // Gross slip erases the memory.
    let responses = [short.step(contact, 3.0 * contact.slip())?.force, long.step(contact, 3.0 * contact.slip())?.force];
    ensure!(responses[0] == responses[1] && short.bits() == long.bits() && short.error() == 0.0, "after gross slip");
    Ok(worst)
}

/// Hundreds of thousands of nested reversals, closed one by one: at each the force is what it was, to the bit.
fn deeply_nested(named: Named, reversals: usize) -> Case {
    Case::new(format!("capacity: {}: {reversals} reversals", named.name), reversals as u64, move |run| {
        let contact = &named.contact;
        // Ranges decrease linearly, so that all are far above rounding.
        let size = |i: usize| 0.9 * contact.slip() * (reversals - i) as f64 / reversals as f64;
        let inwards: Vec<f64> = (0..reversals).map(|i| if i % 2 == 0 { size(i) } else { -size(i) }).collect();
        let mut state = State::new(reversals);
        let [forces, ..] = path(contact, &mut state, &inwards, [true, false, false], true)?;
        let forces = forces.unwrap_or_default();
        ensure!(state.depth() == reversals - 1, "{} reversals", state.depth());
        let outwards: Vec<f64> = inwards.iter().rev().skip(1).copied().collect();
        let [back, ..] = path(contact, &mut state, &outwards, [true, false, false], true)?;
        for (place, (force, before)) in back.unwrap_or_default().iter().zip(forces.iter().rev().skip(1)).enumerate() {
            ensure!(force == before, "reversal {}: {before:?}, then {force:?}\n  {contact:?}", reversals - 1 - place);
        }
        ensure!(state.depth() == 0, "{} reversals remain", state.depth());
        let response: Response = state.step(contact, 0.95 * contact.slip())?;
        let unloaded = State::new(0).step(contact, 0.95 * contact.slip())?;
        ensure!(
            response == Response { dissipated: response.dissipated, ..unloaded },
            "off the initial loading curve: {response:?}"
        );
        run.done(reversals as u64);
        Ok(String::new())
    })
}
