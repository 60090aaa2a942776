//! What the harmonic balance requires of a contact law: to advance along a periodic displacement, and to be evaluated and
//! differentiated on the way.
//!
//! Between two events (a reversal, the closure of a loop, the onset of gross slip) the force follows one branch. On a branch that
//! leaves reversal r, `dT = k (dδ - dδ_r) + dT_r` with the tangent stiffness k: the reversals on the stack are all that the
//! derivative depends on.

/// A point of a load history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    pub displacement: f64,
    pub force: f64,
}

/// Storage of a reversal on the stack: displacement, force, and a value of the law's own.
pub(crate) type Reversal = [f64; 3];

/// Force \[N\] and tangent stiffness \[N/m\] at a displacement.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Response {
    pub force: f64,
    pub stiffness: f64,
}

/// The range of displacements on a branch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BranchRange {
    /// Number of reversals on the stack up to the one that the branch leaves; 0 for the initial loading curve.
    pub depth: usize,
    /// +1 or -1.
    pub direction: f64,
    /// Displacement at which it ends; infinite in gross slip.
    pub end: f64,
    /// The force is constant.
    pub gross_slip: bool,
}

/// Evaluates the response at displacements on one branch without gross slip.
pub(crate) trait Evaluator: Copy {
    fn at(&self, displacement: f64) -> Response;
}

/// A contact law in the steady state of a periodic displacement.
pub(crate) trait Law {
    type Evaluator: Evaluator;

    /// Enters the steady state at the displacement farthest from zero, where no reversal is on the stack.
    fn begin(&mut self, displacement: f64) -> Response;

    /// Range of the present branch.
    fn branch(&self) -> BranchRange;

    /// Evaluator of the present branch.
    fn evaluator(&self) -> Self::Evaluator;

    /// Response at a displacement on the present branch.
    fn response(&self, displacement: f64) -> Response;

    /// Applies a step from a point of the present branch, which may reverse, close loops and slip. Returns whether the point has
    /// become a reversal that is still on the stack.
    fn advance(&mut self, from: Point, displacement: f64) -> bool;

    /// Makes a point of the present branch the newest reversal; `false` if the stack has no room.
    fn reverse(&mut self, at: Point, direction: f64) -> bool;

    /// Whether gross slip starts at the end of the present branch.
    fn ends_in_gross_slip(&self) -> bool;

    /// Passes from the end of the present branch to its continuation.
    fn pass_end(&mut self);

    /// Accounts for a motion along the present branch: its energy, and the displacement of the slider in gross slip.
    fn account_for(&mut self, from: f64, to: f64);

    /// The energy \[J\] dissipated since the beginning, if it was requested.
    fn dissipated(self) -> Option<f64>;
}
