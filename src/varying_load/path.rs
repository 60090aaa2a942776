//! Results of a step, and of load histories of several steps.

/// Result of a step, with vectors `[T, N]` or `[Tx, Ty, N]`, and tangents of 2 x 2 or 3 x 3 entries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepResult<V, T> {
    /// Tangential forces and normal force \[N\].
    pub force: V,
    /// Derivatives of the force with respect to the tangential displacements \[N/m\] and the normal component, column by column.
    pub tangent: T,
    /// \[J\]; 0 unless requested.
    pub dissipated: f64,
}

impl StepResult<[f64; 3], [f64; 9]> {
    pub(crate) const NONE: Self = StepResult { force: [0.0; 3], tangent: [0.0; 9], dissipated: 0.0 };
}

/// Outputs of a path, step after step; `None` is not computed.
#[derive(Debug)]
pub struct PathOutput<'a> {
    /// `[T, N]` or `[Tx, Ty, N]` per step \[N\].
    pub force: Option<&'a mut [f64]>,
    /// A tangent per step, 2 x 2 or 3 x 3, column-major.
    pub tangent: Option<&'a mut [f64]>,
    /// One double per step \[J\].
    pub dissipated: Option<&'a mut [f64]>,
}

/// Applies `step` to the displacements of a path one after the other, and writes the force, the tangent and the energy of each.
#[inline(always)]
pub(crate) fn advance_along<const M: usize, const MM: usize>(
    path: &[f64],
    output: PathOutput,
    mut step: impl FnMut([f64; M]) -> StepResult<[f64; M], [f64; MM]>,
) {
    let PathOutput { force, tangent, dissipated } = output;
    let mut forces = force.unwrap_or(&mut []).as_chunks_mut().0.iter_mut();
    let mut tangents = tangent.unwrap_or(&mut []).as_chunks_mut().0.iter_mut();
    let mut energies = dissipated.unwrap_or(&mut []).iter_mut();
    for displacement in path.as_chunks().0 {
        let step = step(*displacement);
        forces.next().into_iter().for_each(|force| *force = step.force);
        tangents.next().into_iter().for_each(|tangent| *tangent = step.tangent);
        energies.next().into_iter().for_each(|energy| *energy = step.dissipated);
    }
}
