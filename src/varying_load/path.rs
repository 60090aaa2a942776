//! Load histories of several steps.

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
    mut step: impl FnMut([f64; M]) -> ([f64; M], [f64; MM], f64),
) {
    let PathOutput { force, tangent, dissipated } = output;
    let mut forces = force.unwrap_or(&mut []).as_chunks_mut().0.iter_mut();
    let mut tangents = tangent.unwrap_or(&mut []).as_chunks_mut().0.iter_mut();
    let mut energies = dissipated.unwrap_or(&mut []).iter_mut();
    for displacement in path.as_chunks().0 {
        let (force, tangent, dissipated) = step(*displacement);
        forces.next().into_iter().for_each(|place| *place = force);
        tangents.next().into_iter().for_each(|place| *place = tangent);
        energies.next().into_iter().for_each(|place| *place = dissipated);
    }
}
