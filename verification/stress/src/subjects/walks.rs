//! Long walks: every contact through every kind of history, everything checked on each step.

use crate::walk::{Checks, Walk};
use crate::{Case, contacts, histories};

/// Steps between two reports of progress.
const BATCH: u64 = 10_000;

/// First steps that get every check, afterwards each is made now and then.
const WATCHED: u64 = 500;

/// Each kind of history in full length with one contact, and a twentieth of it with the others.
pub fn cases(steps: u64) -> Vec<Case> {
    let mut cases = Vec::new();
    for (number, contact) in contacts::all().into_iter().enumerate() {
        for (kind, name) in histories::names().into_iter().enumerate() {
            let steps = if kind == number { steps } else { steps.div_ceil(20) };
            let contact = contact.clone();
            cases.push(Case::new(format!("walk: {}: {name}", contact.name), steps, move |run| {
                let contact = &contact.contact;
                let (_, mut history) = histories::all(contact.slip()).swap_remove(kind);
                let mut walk = Walk::new(contact, 4);
                for number in 0..steps {
                    let displacement = history(&walk.memory, &mut run.rng);
                    let checks = if number < WATCHED { Checks::ALL } else { Checks::now_and_then(&mut run.rng) };
                    walk.step(displacement, checks, &mut run.rng)
                        .map_err(|failure| format!("step {number}: {failure}\n  {contact:?}"))?;
                    if number % BATCH == BATCH - 1 {
                        run.done(BATCH);
                    }
                }
                run.done(steps % BATCH);
                Ok(format!("{} reversals at most", walk.deepest))
            }));
        }
    }
    cases
}
