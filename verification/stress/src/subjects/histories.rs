//! Every contact through every kind of history, with checks on each step.

use crate::checked::{CheckedHistory, Checks};
use crate::{Case, contacts, histories};

/// Steps between two reports of progress.
const BATCH: u64 = 10_000;

/// Steps with every check; afterwards the expensive ones are made from time to time.
const FULLY_CHECKED: u64 = 500;

/// Each kind of history in full length with one contact, a twentieth of it with the others.
pub fn cases(steps: u64) -> Vec<Case> {
    let mut cases = Vec::new();
    for (number, contact) in contacts::all().into_iter().enumerate() {
        for (kind, name) in histories::names().into_iter().enumerate() {
            let steps = if kind == number { steps } else { steps.div_ceil(20) };
            let contact = contact.clone();
            cases.push(Case::new(format!("history: {}: {name}", contact.name), steps, move |run| {
                let contact = &contact.contact;
                let (_, mut history) = histories::all(contact.slip()).swap_remove(kind);
                let mut checked = CheckedHistory::new(contact, 4);
                for number in 0..steps {
                    let displacement = history(&checked.memory, &mut run.rng);
                    let checks = if number < FULLY_CHECKED { Checks::ALL } else { Checks::now_and_then(&mut run.rng) };
                    checked
                        .step(displacement, checks, &mut run.rng)
                        .map_err(|failure| format!("step {number}: {failure}\n  {contact:?}"))?;
                    if number % BATCH == BATCH - 1 {
                        run.done(BATCH);
                    }
                }
                run.done(steps % BATCH);
                Ok(format!("{} reversals at most", checked.deepest))
            }));
        }
    }
    cases
}
