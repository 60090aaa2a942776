//! The state of the springs: what a step changes.

use crate::element::springs::{Both, FINE, Row, SPRINGS};
use crate::two_directions::fine::FineRow;

/// Displacements of the springs, tractions over the pressure at the points, and the fine bank; both pressures of the
/// edge.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(crate) struct SpringState {
    pub springs: Both<Row>,
    pub tractions: Both<Row>,
    pub shell_pressure: Row,
    pub pressure: Row,
    pub fine: Both<FineRow>,
}

impl SpringState {
    pub const RELAXED: SpringState = SpringState {
        springs: [[0.0; SPRINGS]; 2],
        tractions: [[0.0; SPRINGS]; 2],
        shell_pressure: [0.0; SPRINGS],
        pressure: [0.0; SPRINGS],
        fine: [[0.0; FINE]; 2],
    };
}

/// The same in an array.
pub(crate) struct StoredSprings<'a> {
    pub springs: Both<&'a Row>,
    pub tractions: Both<&'a Row>,
    pub shell_pressure: &'a Row,
    pub pressure: &'a Row,
    pub fine: Both<&'a FineRow>,
}

impl<'a> StoredSprings<'a> {
    /// From the values behind the header of a state.
    #[inline(always)]
    pub fn new(values: &'a [f64]) -> Option<StoredSprings<'a>> {
        let (springs_x, rest) = values.split_first_chunk()?;
        let (springs_y, rest) = rest.split_first_chunk()?;
        let (tractions_x, rest) = rest.split_first_chunk()?;
        let (tractions_y, rest) = rest.split_first_chunk()?;
        let (shell_pressure, rest) = rest.split_first_chunk()?;
        let (pressure, rest) = rest.split_first_chunk()?;
        let (fine_x, rest) = rest.split_first_chunk()?;
        let fine_y = rest.first_chunk()?;
        Some(StoredSprings {
            springs: [springs_x, springs_y],
            tractions: [tractions_x, tractions_y],
            shell_pressure,
            pressure,
            fine: [fine_x, fine_y],
        })
    }

    pub fn copy_to(&self, state: &mut SpringState) {
        for k in 0..2 {
            (state.springs[k], state.tractions[k]) = (*self.springs[k], *self.tractions[k]);
            state.fine[k] = *self.fine[k];
        }
        (state.shell_pressure, state.pressure) = (*self.shell_pressure, *self.pressure);
    }
}

/// A motion over more than this many slip displacements is shortened to it: the force does not depend on the rest, and the energy is
/// proportional.
pub(super) const LONGEST: f64 = 1e9;
