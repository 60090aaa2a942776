//! Interface between harmonic balance and a contact law: advancing along a periodic displacement, evaluation, differentiation.
//!
//! Between two events (a reversal, the closure of a loop, the onset of gross slip) the force follows one branch. On a branch that
//! leaves reversal r, `dT = k (dδ - dδ_r) + dT_r` with the tangent stiffness k: the derivative depends only on the reversals on the
//! stack.

use crate::constant_load::sensitivity::Sensitivity;

/// A point of a load history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    pub displacement: f64,
    pub force: f64,
}

/// Storage of a reversal on the stack: displacement, force, and a value private to the law.
pub(crate) type Reversal = [f64; 3];

/// Force \[N\] and tangent stiffness \[N/m\] at a displacement.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Response {
    pub force: f64,
    pub stiffness: f64,
}

/// Range of displacements of a branch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BranchRange {
    /// Number of reversals on the stack up to the one that the branch leaves; 0 for the initial loading curve.
    pub depth: usize,
    /// +1 or -1.
    pub direction: f64,
    /// Displacement at which it ends; infinite in gross slip.
    pub end: f64,
    /// The contact is in gross slip: the force is constant.
    pub gross_slip: bool,
}

/// Values behind those that are evaluated, so that whole blocks of four can be read and written from any value on.
pub(crate) const BEYOND: usize = 6;

/// Evaluates the response at displacements on one branch without gross slip.
pub(crate) trait Evaluator: Copy {
    fn at(&self, displacement: f64) -> Response;

    /// Forces, and stiffnesses if requested, at `count` displacements in the order of the branch, with the same bits. All arrays, of
    /// which the first two are scratch memory, have at least [`BEYOND`] more values; those of the outputs are overwritten.
    fn along<const STIFFNESS: bool>(
        &self,
        count: usize,
        displacement: &[f64],
        scratch: [&mut [f64]; 2],
        forces: &mut [f64],
        stiffnesses: &mut [f64],
    );
}

/// A contact law in the steady state of a periodic displacement.
pub(crate) trait Law {
    type Evaluator: Evaluator;

    /// Enters the steady state, with an empty stack, at the displacement of largest magnitude.
    fn begin(&mut self, displacement: f64) -> Response;

    /// Range of the present branch.
    fn branch(&self) -> BranchRange;

    /// Evaluator of the present branch.
    fn evaluator(&self) -> Self::Evaluator;

    /// Response at a displacement on the present branch.
    fn response(&self, displacement: f64) -> Response;

    /// Derivatives of the force at a displacement on the present branch, less those at the reversal that it leaves.
    fn sensitivity(&self, displacement: f64) -> Sensitivity;

    /// Applies a step from a point of the present branch, which may reverse, close loops and enter gross slip. Returns whether the
    /// point is now a reversal on the stack.
    fn advance(&mut self, from: Point, displacement: f64) -> bool;

    /// Pushes a point of the present branch as the newest reversal; returns `false` if the stack is full.
    fn reverse(&mut self, at: Point, direction: f64) -> bool;

    /// Whether gross slip starts at the end of the present branch.
    fn ends_in_gross_slip(&self) -> bool;

    /// Continues on the branch that follows at the end of the present one.
    fn pass_end(&mut self);

    /// Adds the energy dissipated along the present branch and, in gross slip, moves the slider.
    fn account_for(&mut self, from: f64, to: f64);

    /// Energy \[J\] dissipated since `begin`, if requested.
    fn dissipated(self) -> Option<f64>;
}
