//! The same history step by step, as a path in one call or in two, with any outputs, and as a batch: bitwise the same results.

use crate::contacts::Named;
use crate::library::{State, accepted, path, trapped};
use crate::memory::{Memory, Point};
use crate::{Case, contacts, ensure, histories};
use microslip::ffi::{self, mslip_contact};
use rand::Rng;
use rand::seq::SliceRandom;
use std::ptr::null;

/// Steps of a piece, and reversals that a state holds.
const PIECE: usize = 100;

pub fn cases(pieces: u64) -> Vec<Case> {
    let mut cases = Vec::new();
    for contact in contacts::all() {
        for (kind, name) in histories::names().into_iter().enumerate() {
            cases.push(paths(contact.clone(), kind, name, pieces));
        }
    }
    cases.push(many_contacts(pieces * PIECE as u64));
    cases
}

fn paths(named: Named, kind: usize, name: &str, pieces: u64) -> Case {
    Case::new(format!("path: {}: {name}", named.name), pieces * PIECE as u64, move |run| {
        let contact = &named.contact;
        let (_, mut history) = histories::all(contact.slip()).swap_remove(kind);
        let mut memory = Memory::new(contact.slip());
        let (mut single, mut whole) = (State::new(PIECE), State::new(PIECE));
        for piece in 0..pieces {
            // A piece adds as many reversals as it has steps, so every few pieces start anew.
            if single.depth() > PIECE / 2 {
                (single, whole, memory) = (State::new(PIECE), State::new(PIECE), Memory::new(contact.slip()));
            }
            let start = whole.clone();
            let mut responses = [const { Vec::new() }; 3];
            let mut displacements = Vec::new();
            while displacements.len() < PIECE && single.depth() + 1 < PIECE {
                let displacement = history(&memory, &mut run.rng);
                let response = single.step(contact, displacement)?;
                memory.visit(Point { displacement, force: response.force }, single.slips());
                displacements.push(displacement);
                responses[0].push(response.force);
                responses[1].push(response.stiffness);
                responses[2].push(response.dissipated);
            }
            let requested: [bool; 3] = run.rng.random();
            let kept = run.rng.random_bool(0.9);
            // One call, or two that share the path.
            let cut = if run.rng.random() { run.rng.random_range(0..=displacements.len()) } else { 0 };
            let mut state = start.clone();
            let mut found = [const { Vec::new() }; 3];
            for (part, kept) in [(&displacements[..cut], true), (&displacements[cut..], kept)] {
                let before = state.clone();
                let outputs = path(contact, &mut state, part, requested, kept)?;
                for (found, output) in found.iter_mut().zip(outputs) {
                    found.extend(output.unwrap_or_default());
                }
                ensure!(kept || state == before, "a discarded step changed the state");
            }
            for ((requested, found), expected) in requested.iter().zip(&found).zip(&responses) {
                ensure!(
                    !requested || found == expected,
                    "piece {piece} from {:?} along {displacements:?}: {found:?}, step by step {expected:?}\n  {contact:?}",
                    start.used()
                );
            }
            ensure!(
                !kept || state.bits() == single.bits(),
                "piece {piece} from {:?} along {displacements:?} gives the state {:?}, step by step {:?}\n  {contact:?}",
                start.used(),
                state.used(),
                single.used()
            );
            whole = single.clone();
            run.done(PIECE as u64);
        }
        Ok(String::new())
    })
}

/// All contacts as a batch, by their index, some of them inactive in each call.
fn many_contacts(steps: u64) -> Case {
    Case::new("batch: all contacts at once".to_owned(), steps, move |run| {
        let mut contacts = contacts::all();
        contacts.shuffle(&mut run.rng);
        let n = contacts.len();
        let together: Vec<mslip_contact> = contacts.iter().rev().map(|named| named.contact.copied()).collect();
        let index: Vec<i32> = (0..n as i32).rev().collect();
        let unloaded = State::new(PIECE);
        let length = unloaded.0.len();
        let (mut singles, mut states) = (vec![unloaded.clone(); n], unloaded.0.repeat(n));
        let mut histories: Vec<histories::History> = contacts
            .iter()
            .map(|named| {
                let mut all = histories::all(named.contact.slip());
                let kind = run.rng.random_range(0..all.len());
                all.swap_remove(kind).1
            })
            .collect();
        let mut memories: Vec<Memory> = contacts.iter().map(|named| Memory::new(named.contact.slip())).collect();
        const UNWRITTEN: f64 = -7.0e77;
        for step in 0..steps {
            let mut displacement = vec![0.0; n];
            let (mut active, mut expected) = (vec![0; n], vec![[UNWRITTEN; 3]; n]);
            for (i, named) in contacts.iter().enumerate() {
                let contact = &named.contact;
                if singles[i].depth() + 1 >= PIECE {
                    singles[i] = State::new(PIECE);
                    memories[i] = Memory::new(contact.slip());
                    states[i * length..(i + 1) * length].copy_from_slice(&singles[i].0);
                }
                active[i] = run.rng.random_range(-1..=1);
                if active[i] != 0 {
                    displacement[i] = histories[i](&memories[i], &mut run.rng);
                    let response = singles[i].step(contact, displacement[i])?;
                    memories[i]
                        .visit(Point { displacement: displacement[i], force: response.force }, singles[i].slips());
                    expected[i] = [response.force, response.stiffness, response.dissipated];
                }
            }
            let mut outputs = [const { Vec::new() }; 3];
            outputs.iter_mut().for_each(|output| output.resize(n, UNWRITTEN));
            let [force, stiffness, dissipated] = outputs.each_mut().map(|output| output.as_mut_ptr());
            let all_active = active.iter().all(|flag| *flag != 0);
            let flags = if all_active { null() } else { active.as_ptr() };
            let state = states.as_mut_ptr();
            // SAFETY: as long as given.
            accepted(trapped(|| unsafe {
                ffi::mslip_batch_masing_update(
                    n,
                    n,
                    together.as_ptr(),
                    index.as_ptr(),
                    flags,
                    length,
                    state,
                    displacement.as_ptr(),
                    state,
                    force,
                    stiffness,
                    dissipated,
                )
            }))?;
            for (i, named) in contacts.iter().enumerate() {
                let found = [outputs[0][i], outputs[1][i], outputs[2][i]];
                let state = State(states[i * length..(i + 1) * length].to_vec());
                ensure!(
                    found == expected[i] && state.bits() == singles[i].bits(),
                    "step {step}: {found:?} and {:?} together, alone {:?} and {:?}\n  {:?}",
                    state.used(),
                    expected[i],
                    singles[i].used(),
                    named.contact
                );
            }
            run.done(1);
        }
        Ok(String::new())
    })
}
