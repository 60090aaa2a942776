//! States of every size: what is full refuses and loses nothing, and what fits goes on.

use crate::contacts::Named;
use crate::library::{Answer, Contact, State, path, trapped};
use crate::{Case, Outcome, contacts, ensure};
use microslip::c_api::{self, MSLIP_STATE_FULL};
use rand::Rng;
use rand_chacha::ChaCha8Rng;

pub fn cases(spirals: u64, deep: usize) -> Vec<Case> {
    let mut cases: Vec<Case> = contacts::all().into_iter().map(|contact| full(contact, spirals)).collect();
    let mut contacts = contacts::all();
    contacts.truncate(2);
    cases.extend(contacts.into_iter().map(|contact| deeply_nested(contact, deep)));
    cases
}

/// Turns of ever smaller swings, each nested in the one before; `ratio` is that of their sizes.
fn spiral(contact: &Contact, turns: usize, ratio: f64) -> Vec<f64> {
    (0..turns as i32).map(|turn| 0.95 * contact.slip() * ratio.powi(turn) * (1 - 2 * (turn % 2)) as f64).collect()
}

fn full(named: Named, spirals: u64) -> Case {
    Case::new(format!("capacity: {}: full states", named.name), spirals, move |run| {
        let contact = &named.contact;
        for _ in 0..spirals {
            let capacity = run.rng.random_range(0..24);
            let turns = capacity + run.rng.random_range(2..10);
            // Swings of nearly the same size, and some that end at the last digits.
            let ratio = *[0.999, 0.9, 0.5, 0.02].get(run.rng.random_range(0..4)).unwrap_or(&0.5);
            let walk = spiral(contact, turns, ratio);
            refused_and_moved(contact, capacity, &walk, &mut run.rng)
                .map_err(|failure| format!("{failure}\n  capacity {capacity}, path {walk:?}\n  {contact:?}"))?;
            run.done(1);
        }
        Ok(String::new())
    })
}

fn refused_and_moved(contact: &Contact, capacity: usize, walk: &[f64], rng: &mut ChaCha8Rng) -> Outcome {
    let (mut short, mut long) = (State::new(capacity), State::new(walk.len()));
    // The first step leaves the virgin curve, and every other one a reversal behind.
    let (fits, rest) = walk.split_at(capacity + 1);
    for displacement in fits {
        let answers = [short.step(contact, *displacement)?, long.step(contact, *displacement)?];
        ensure!(answers[0] == answers[1], "in a short and a long state: {answers:?}");
    }
    ensure!(short.depth() == capacity, "{} reversals in a state for {capacity}", short.depth());
    path_is_refused(contact, &short, rest)?;
    step_is_refused(contact, &short, rest[0])?;

    // Towards where the branch goes there is room, and from there the way round is refused as well.
    let mut forth = short.clone();
    let last = walk[capacity];
    forth.step(contact, last * (1.0 + 1e-6))?;
    step_is_refused(contact, &forth, rest[0])?;

    // The whole path at once is refused, too, and leaves nothing.
    path_is_refused(contact, &State::new(capacity), walk)?;

    // It goes on in a longer state, as if it had always been one; and in one just long enough, from there back.
    let mut moved = short.moved(walk.len());
    for displacement in rest {
        let answers = [moved.step(contact, *displacement)?, long.step(contact, *displacement)?];
        ensure!(answers[0] == answers[1] && moved.bits() == long.bits(), "after the move: {answers:?}");
    }
    let mut tight = long.moved(long.depth());
    let outwards = rng.random_range(0..walk.len());
    // Beyond a turn every loop nested in it closes.
    for displacement in [walk[outwards], 1.5 * walk[0], -1.5 * walk[0]] {
        let answers = [tight.step(contact, displacement)?, long.step(contact, displacement)?];
        ensure!(answers[0] == answers[1] && tight.bits() == long.bits(), "unwound: {answers:?}");
    }
    Ok(())
}

/// A path that does not fit is refused as a whole; the state keeps every bit.
fn path_is_refused(contact: &Contact, state: &State, walk: &[f64]) -> Outcome {
    let bits = |state: &State| state.0.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
    for kept in [true, false] {
        let mut here = state.clone();
        let status = path(contact, &mut here, walk, [true, true, true], kept).err();
        ensure!(status == Some(MSLIP_STATE_FULL), "a path too deep: {status:?}");
        ensure!(bits(&here) == bits(state), "a path that was refused has written");
    }
    Ok(())
}

/// A step that does not fit writes neither state nor outputs.
fn step_is_refused(contact: &Contact, state: &State, displacement: f64) -> Outcome {
    const UNWRITTEN: f64 = -7.0e77;
    let mut outputs = [UNWRITTEN; 3];
    let mut target = State(vec![UNWRITTEN; state.0.len()]);
    let [force, stiffness, dissipated] = &mut outputs;
    // SAFETY: as long as said.
    let status = trapped(|| unsafe {
        c_api::mslip_masing_update(
            contact.as_c(),
            state.0.len(),
            state.0.as_ptr(),
            displacement,
            target.0.as_mut_ptr(),
            force,
            stiffness,
            dissipated,
        )
    });
    ensure!(status == MSLIP_STATE_FULL, "a step too deep: {status}");
    ensure!(
        outputs == [UNWRITTEN; 3] && target.0.iter().all(|value| *value == UNWRITTEN),
        "a refused step has written"
    );
    Ok(())
}

/// Hundreds of thousands of reversals within each other, and out again: no force is lost on the way.
fn deeply_nested(named: Named, turns: usize) -> Case {
    Case::new(format!("capacity: {}: {turns} reversals", named.name), turns as u64, move |run| {
        let contact = &named.contact;
        // Swings shrink by the same length each, so that all of them are far above rounding.
        let size = |turn: usize| 0.9 * contact.slip() * (turns - turn) as f64 / turns as f64;
        let inwards: Vec<f64> = (0..turns).map(|turn| if turn % 2 == 0 { size(turn) } else { -size(turn) }).collect();
        // With room for the turns of the way out, too: a path that does not fit is tried out in less memory.
        let mut state = State::new(2 * turns);
        let Ok(path_inwards) = path(contact, &mut state, &inwards, [true, false, false], true) else {
            return Err("the spiral does not fit".to_owned());
        };
        let forces = path_inwards.outputs[0].clone().unwrap_or_default();
        ensure!(state.depth() == turns - 1, "{} reversals", state.depth());
        // Back out, over every reversal in turn: there the force is what it was, to the bit.
        let outwards: Vec<f64> = inwards.iter().rev().skip(1).copied().collect();
        let Ok(path_outwards) = path(contact, &mut state, &outwards, [true, false, false], true) else {
            return Err("the way out does not fit".to_owned());
        };
        let back = path_outwards.outputs[0].clone().unwrap_or_default();
        for (place, (force, before)) in back.iter().zip(forces.iter().rev().skip(1)).enumerate() {
            ensure!(force == before, "reversal {}: {before:?}, then {force:?}\n  {contact:?}", turns - 1 - place);
        }
        ensure!(state.depth() == 0, "{} reversals are left", state.depth());
        let answer: Answer = state.step(contact, 0.95 * contact.slip())?;
        ensure!(
            answer
                == State::new(0)
                    .step(contact, 0.95 * contact.slip())
                    .map(|virgin| Answer { dissipated: answer.dissipated, ..virgin })?,
            "the virgin curve is left: {answer:?}"
        );
        run.done(turns as u64);
        Ok(String::new())
    })
}
