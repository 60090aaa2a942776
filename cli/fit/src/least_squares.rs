//! Weighted least squares over all loops, by the method of Levenberg and Marquardt.
//!
//! The residuals are differences of force over their standard deviation: noise of the force, and noise of the displacement times
//! the slope of the loop. Each loop has parameters of its own: offset and drift of the force, and the errors of the displacement at
//! its reversals, with one more residual each, over their standard error.

use crate::cycles::{Loop, Sample};
use crate::data::{ends, mean, regression};
use crate::error::Error;
use crate::model::{
    CONTACT, Curve, FRICTION, Family, LoopModel, NUISANCES, PARALLEL, PARAMETERS, Prediction, SERIES, SHAPE, STIFFENING,
};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, Owned};

/// Which of the parameters are fitted.
pub(crate) type Free = [bool; PARAMETERS];

/// Least square of the error of the model in a loop, over the mean square of all loops.
const LEAST_ERROR: f64 = 0.1;

/// The loops and a state of the fit.
#[derive(Debug, Clone)]
pub(crate) struct Fit<'a> {
    family: &'a Family,
    loops: &'a [Loop],
    /// For each loop and sample: measured force at the mean normal force, and its standard deviation.
    targets: Vec<Vec<[f64; 2]>>,
    curves: Vec<Curve>,
    pub free: Free,
    /// Whether the share of the stiffness that grows with the load was fitted.
    has_share: bool,
    /// Friction coefficient, series compliance, contact compliance, a/b, share of the series stiffness that grows with the load,
    /// parallel stiffness.
    pub parameters: [f64; PARAMETERS],
    nuisances: Vec<[f64; NUISANCES]>,
    /// Sum of the squares of all residuals, after a minimisation.
    pub chi_squared: f64,
    /// Lower and upper limits of the parameters.
    limits: [[f64; 2]; PARAMETERS],
}

impl<'a> Fit<'a> {
    /// The state with the given parameters, before any iteration.
    pub fn new(
        family: &'a Family,
        loops: &'a [Loop],
        parameters: [f64; PARAMETERS],
        limits: [[f64; 2]; PARAMETERS],
    ) -> Result<Fit<'a>, Error> {
        let middle = |one: &Loop| 0.5 * ends(one.samples.iter().map(|sample| sample.force)).iter().sum::<f64>();
        let mut fit = Fit {
            family,
            loops,
            targets: Vec::new(),
            curves: Vec::new(),
            free: [false; PARAMETERS],
            has_share: false,
            parameters,
            nuisances: loops.iter().map(|one| [middle(one), 0.0, 0.0, 0.0]).collect(),
            chi_squared: f64::INFINITY,
            limits,
        };
        fit.update()?;
        fit.update_targets();
        Ok(fit)
    }

    /// The loops of the fit.
    pub fn loops(&self) -> &'a [Loop] {
        self.loops
    }

    /// The best fit of other loops, under the same contact and loads.
    pub fn of_loops<'b>(&self, loops: &'b [Loop], free: Free) -> Result<Fit<'b>, Error>
    where
        'a: 'b,
    {
        let compliance = |one: &Loop| self.family.compliance(self.parameters[SHAPE], one.normal_force);
        let compliances = loops.iter().map(compliance).collect::<Result<Vec<_>, _>>()?;
        let given = [FRICTION, SERIES, CONTACT].map(|i| (!free[i]).then_some(self.parameters[i]));
        let mut parameters = self.parameters;
        parameters[PARALLEL] *= if free[PARALLEL] { 0.0 } else { 1.0 };
        [parameters[FRICTION], parameters[SERIES], parameters[CONTACT]] = start_values(loops, &compliances, given);
        Ok(Fit::new(self.family, loops, parameters, self.limits)?.minimized(free))
    }

    /// The curves of changed parameters.
    pub fn update(&mut self) -> Result<(), Error> {
        let curve = |one: &Loop| self.family.curve(&self.parameters, one.normal_force, self.has_share);
        let curves = self.loops.iter().map(curve);
        self.curves = curves.collect::<Result<_, _>>()?;
        Ok(())
    }

    fn models(&self) -> impl Iterator<Item = (&Loop, LoopModel<'_>)> {
        let of_loop = self.loops.iter().zip(&self.curves).zip(&self.nuisances);
        of_loop.map(|((one, curve), nuisances)| (one, LoopModel::new(one, curve, self.parameters[PARALLEL], nuisances)))
    }

    /// Weights, and forces at the mean normal force, from the present model. What the noise does not explain of the misfit of a
    /// loop is an error of the model, of the same size everywhere. A loop that is fitted better than the others by chance has not
    /// all the weight.
    pub fn update_targets(&mut self) {
        let target = |(one, model): (&Loop, LoopModel)| {
            let [of_displacement, of_force] = one.noise;
            let at = |sample: &Sample| {
                let at = model.at(sample);
                let force = sample.force - model.load_effect(sample);
                let variance = of_force.powi(2) + (at.stiffness * of_displacement).powi(2);
                ([force, variance], (force - at.force).powi(2) - variance)
            };
            let (targets, excess): (Vec<_>, Vec<_>) = one.samples.iter().map(at).unzip();
            (targets, mean(excess.into_iter()) / one.height().powi(2))
        };
        let (mut targets, excesses): (Vec<Vec<_>>, Vec<f64>) = self.models().map(target).unzip();
        // Computed loops may have no noise.
        let least = (LEAST_ERROR * mean(excesses.iter().copied())).max(1e-14);
        for ((one, targets), excess) in self.loops.iter().zip(&mut targets).zip(excesses) {
            let excess = excess.max(least) * one.height().powi(2);
            targets.iter_mut().for_each(|[_, variance]| *variance = (*variance + excess).sqrt());
        }
        self.targets = targets;
    }

    /// Fits, with weights that follow the model.
    pub fn settle(&mut self, free: Free) {
        for _ in 0..3 {
            self.minimize(free);
            self.update_targets();
        }
        self.minimize(free);
    }

    /// Minimises over the free parameters. A parameter at a limit stays there as long as the residuals push it outwards.
    pub fn minimize(&mut self, free: Free) {
        let method = LevenbergMarquardt::new().with_ftol(1e-8).with_xtol(1e-6).with_gtol(1e-8).with_patience(10);
        let mut fixed = self.limits_at_which(|_| true);
        self.has_share |= free[STIFFENING];
        for _ in 0..=PARAMETERS {
            self.free = std::array::from_fn(|i| free[i] && !fixed[i]);
            if self.update().is_err() {
                break;
            }
            *self = method.minimize(self.clone()).0;
            self.free = free;
            if self.update().is_err() {
                break;
            }
            let Some((residuals, jacobian)) = self.residuals().zip(self.jacobian()) else { break };
            let gradient = jacobian.tr_mul(&residuals);
            let columns = self.columns();
            let pushed = self.limits_at_which(|i| {
                let place = columns.iter().position(|column| *column == i);
                let slope = place.map_or(0.0, |place| gradient[place]);
                if self.parameters[i] == self.limits[i][0] { slope > 0.0 } else { slope < 0.0 }
            });
            if (0..PARAMETERS).all(|i| !free[i] || pushed[i] == fixed[i]) {
                break;
            }
            fixed = pushed;
        }
        self.chi_squared = self.residuals().map_or(f64::INFINITY, |residuals| residuals.norm_squared());
    }

    /// The fit after [`Fit::minimize`].
    pub fn minimized(mut self, free: Free) -> Fit<'a> {
        self.minimize(free);
        self
    }

    /// Which parameters are at a limit, and meet a condition.
    fn limits_at_which(&self, condition: impl Fn(usize) -> bool) -> [bool; PARAMETERS] {
        std::array::from_fn(|i| self.limits[i].contains(&self.parameters[i]) && condition(i))
    }

    /// Number of free parameters, without the corrections of the reversals, which have residuals of their own.
    pub fn count(&self) -> usize {
        self.params().len() - 2 * self.loops.len()
    }

    fn columns(&self) -> Vec<usize> {
        (0..PARAMETERS).filter(|i| self.free[*i]).collect()
    }

    fn has_nuisance(&self, index: usize, nuisance: usize) -> bool {
        nuisance != 1 || self.loops[index].has_drift
    }

    /// All weighted residuals, without the corrections of the reversals.
    pub fn weighted_residuals(&self) -> Vec<Vec<f64>> {
        let of_loop = |((one, model), targets): ((&Loop, LoopModel), &Vec<[f64; 2]>)| {
            let residual = |(sample, [force, sigma]): (_, &[f64; 2])| (force - model.at(sample).force) / sigma;
            one.samples.iter().zip(targets).map(residual).collect()
        };
        self.models().zip(&self.targets).map(of_loop).collect()
    }

    /// Measured and computed force, without offset and drift, at the samples of each loop.
    pub fn forces(&self) -> Vec<Vec<[f64; 2]>> {
        let of_loop = |((one, model), [offset, drift, ..]): ((&Loop, LoopModel), &[f64; NUISANCES])| {
            let at = |sample: &Sample| {
                let zero = offset + drift * sample.time;
                [sample.force - zero, model.at(sample).force - zero + model.load_effect(sample)]
            };
            one.samples.iter().map(at).collect()
        };
        self.models().zip(&self.nuisances).map(of_loop).collect()
    }

    /// Predictions without offset and drift, and the standard deviations of the residuals, at the samples of each loop.
    pub fn predictions(&self) -> impl Iterator<Item = (&Loop, Vec<(Prediction, f64)>)> {
        self.models().zip(&self.nuisances).zip(&self.targets).map(|(((one, model), nuisances), targets)| {
            let at = |(sample, [_, sigma]): (&Sample, &[f64; 2])| {
                let at = model.at(sample);
                (Prediction { force: at.force - nuisances[0] - nuisances[1] * sample.time, ..at }, *sigma)
            };
            (one, one.samples.iter().zip(targets).map(at).collect())
        })
    }

    /// All residuals, measured less computed, and an orthonormal basis of their derivatives with respect to the free parameters.
    pub fn basis(&self) -> Option<(DVector<f64>, DMatrix<f64>)> {
        Some((-self.residuals()?, self.jacobian()?.qr().q()))
    }

    /// Enlarges the distance of all parameters from others by this part, as far as the limits admit.
    pub fn extrapolate(&mut self, from: &[f64; PARAMETERS], part: f64) -> Result<(), Error> {
        for (i, [low, high]) in self.limits.into_iter().enumerate().filter(|(_, [low, high])| low < high) {
            self.parameters[i] = (self.parameters[i] + part * (self.parameters[i] - from[i])).clamp(low, high);
        }
        self.update()
    }

    /// Removes residuals from the measured forces.
    pub fn remove(&mut self, residuals: &DVector<f64>) {
        let targets = self.targets.iter_mut().flatten();
        targets.zip(residuals.iter()).for_each(|([force, sigma], residual)| *force -= residual * *sigma);
    }

    /// Frees parameters, except those at a limit, and a shape or a share without effect.
    pub fn release(&mut self, free: Free) {
        let at_limit = self.limits_at_which(|_| true);
        self.free = std::array::from_fn(|i| free[i] && !at_limit[i]);
        self.free[SHAPE] &= self.parameters[CONTACT] > 0.0;
        self.free[STIFFENING] &= self.parameters[SERIES] > 0.0;
    }

    /// The largest normal force over the smallest one.
    pub fn range_of_loads(&self) -> f64 {
        let [least, largest] = ends(self.loops.iter().map(|one| one.normal_force));
        largest / least
    }

    /// Largest displacement of each loop over that at the onset of gross slip.
    pub fn slip_ratios(&self) -> Vec<f64> {
        let of_loop = |(one, curve): (&Loop, &Curve)| one.amplitude / curve.slip_displacement();
        self.loops.iter().zip(&self.curves).map(of_loop).collect()
    }

    /// The least slope of a plateau that rises by μN from the middle to the end of a loop.
    pub fn plateau_slope(&self) -> f64 {
        let of_loop = |one: &Loop| self.parameters[FRICTION] * one.normal_force / one.amplitude;
        self.loops.iter().map(of_loop).fold(f64::INFINITY, f64::min)
    }

    /// Largest force of the law at the mean normal force, less an error, over the normal force.
    pub fn carried(&self, error: f64) -> f64 {
        let of_loop = |(one, model): (&Loop, LoopModel)| (model.end.force - error) / one.normal_force;
        self.models().map(of_loop).fold(0.0, f64::max)
    }

    /// Initial compliance of the law under the normal force of the contact, and its derivative with respect to the shape.
    pub fn law_compliance(&self) -> [f64; 2] {
        let at = |shape: f64| self.family.reference_compliance(shape).unwrap_or(f64::NAN);
        // The compliance depends on the shape by a logarithm only: a one-sided difference suffices for an interval.
        let (step, here) = (1e-4, at(self.parameters[SHAPE]));
        [here, (at(self.parameters[SHAPE] + step) - here) / step]
    }

    /// Variances of linear combinations of the parameters, of which only the free ones vary, if the residuals have variance 1.
    pub fn variances<const COUNT: usize>(&self, combinations: &[[f64; PARAMETERS]; COUNT]) -> [f64; COUNT] {
        let Some(mut jacobian) = self.jacobian() else { return [f64::NAN; COUNT] };
        let norms: Vec<_> = jacobian.column_iter().map(|column| column.norm().max(f64::MIN_POSITIVE)).collect();
        for (mut column, norm) in jacobian.column_iter_mut().zip(&norms) {
            column /= *norm;
        }
        // With J = QR, the variance of wᵀp is |R⁻ᵀw|²; without squares of the condition of J.
        let (upper, columns) = (jacobian.qr().r(), self.columns());
        combinations.map(|combination| {
            let mut weights = DVector::zeros(norms.len());
            for (k, i) in columns.iter().enumerate() {
                weights[k] = combination[*i] / norms[k];
            }
            upper.tr_solve_upper_triangular(&weights).map_or(f64::INFINITY, |solution| solution.norm_squared())
        })
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Fit<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, values: &DVector<f64>) {
        let mut values = values.iter().copied();
        for i in self.columns() {
            let [low, high] = self.limits[i];
            self.parameters[i] = values.next().unwrap_or(f64::NAN).clamp(low, high);
        }
        for index in 0..self.loops.len() {
            for nuisance in 0..NUISANCES {
                if self.has_nuisance(index, nuisance) {
                    self.nuisances[index][nuisance] = values.next().unwrap_or(f64::NAN);
                }
            }
        }
        if self.update().is_err() {
            self.nuisances[0][0] = f64::NAN;
        }
    }

    fn params(&self) -> DVector<f64> {
        let own = self.columns().into_iter().map(|i| self.parameters[i]);
        let of_loop = |index: usize| {
            (0..NUISANCES).filter(move |i| self.has_nuisance(index, *i)).map(move |i| self.nuisances[index][i])
        };
        DVector::from_vec(own.chain((0..self.loops.len()).flat_map(of_loop)).collect())
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let reversals = self.loops.iter().zip(&self.nuisances);
        let reversals = reversals.flat_map(|(one, [_, _, low, high])| [low, high].map(|at| at / one.reversal_error));
        let residuals: Vec<_> =
            self.weighted_residuals().into_iter().flatten().map(|residual| -residual).chain(reversals).collect();
        residuals.iter().all(|residual| residual.is_finite()).then(|| DVector::from_vec(residuals))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let own = self.columns();
        let rows = self.loops.iter().map(|one| one.samples.len() + 2).sum();
        let mut jacobian = DMatrix::zeros(rows, self.params().len());
        let (mut row, mut column, priors) = (0, own.len(), rows - 2 * self.loops.len());
        for (index, ((one, model), targets)) in self.models().zip(&self.targets).enumerate() {
            let of_loop: Vec<_> = (0..NUISANCES).filter(|i| self.has_nuisance(index, *i)).collect();
            for (sample, [_, sigma]) in one.samples.iter().zip(targets) {
                let at = model.at(sample);
                for (k, i) in own.iter().enumerate() {
                    jacobian[(row, k)] = at.slopes[*i] / sigma;
                }
                for (k, i) in of_loop.iter().enumerate() {
                    jacobian[(row, column + k)] = at.nuisance_slopes[*i] / sigma;
                }
                row += 1;
            }
            column += of_loop.len();
            for k in [0, 1] {
                jacobian[(priors + 2 * index + k, column - 2 + k)] = 1.0 / one.reversal_error;
            }
        }
        Some(jacobian)
    }
}

/// Start values of friction coefficient and compliances, from the heights of the loops and the slopes after the reversals.
pub(crate) fn start_values(loops: &[Loop], compliances: &[f64], given: [Option<f64>; 3]) -> [f64; 3] {
    let friction = loops.iter().map(|one| one.height() / one.normal_force).fold(0.0, f64::max);
    let friction = given[FRICTION].unwrap_or(friction);
    let total = mean(loops.iter().map(|one| initial_compliance(one, one.height())));
    let law = mean(compliances.iter().copied());
    let contact = given[CONTACT].unwrap_or_else(|| {
        let rest = total - given[SERIES].unwrap_or(0.0);
        if given[SERIES].is_none() && rest > law { 1.0 } else { (rest / law).max(1e-3) }
    });
    let series = given[SERIES].unwrap_or((total - contact * law).max(1e-3 * total));
    [friction, series, contact]
}

/// du/dT over the first part of the branches: the regression of displacement on force up to 30 % of the height of the loop.
fn initial_compliance(one: &Loop, height: f64) -> f64 {
    let middle = mean(one.samples.iter().map(|sample| sample.force));
    let rise = |sample: &Sample| sample.direction * (sample.force - middle) + height;
    let pairs = one.samples.iter().map(|sample| (rise(sample), sample.distance));
    let [.., compliance] = regression(pairs.filter(|(rise, _)| *rise < 0.6 * height));
    if compliance > 0.0 { compliance } else { one.amplitude / height.max(f64::MIN_POSITIVE) }
}
