//! Checks of a record: what is wrong in it is reported before anything is fitted.

use crate::error::{Error, error};
use crate::input::{Measurement, NormalForce};

/// A record whose numbers are finite and whose columns are complete.
#[derive(Debug, Clone)]
pub(crate) struct Record {
    pub name: String,
    /// Time, or the index, as a fraction of the record from -1 to 1.
    pub time: Vec<f64>,
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
    /// Normal force, smoothed.
    pub normal_force: Vec<f64>,
    /// Standard deviation of the noise of displacement and force.
    pub noise: [f64; 2],
    /// Smallest difference between two values of the force: the step of a digitiser.
    pub resolution: f64,
    /// Samples of the measurement that are averaged in one, and their time; without times, their number.
    pub interval: f64,
    pub step: f64,
    /// What was left out.
    pub warnings: Vec<String>,
}

/// Rows with a number missing, and spikes, that are left out at most, over all rows.
const MOST_MISSING: f64 = 0.05;
const MOST_SPIKES: f64 = 0.01;
/// A spike is a single sample. It differs from both neighbours by more than this factor times each other step among the three
/// samples before and after, and this multiple of the noise.
const SPIKE: [f64; 2] = [4.0, 8.0];

/// Samples that a record needs at least.
const LEAST_SAMPLES: usize = 40;
/// A longer step of time, over the median, is a gap: missing rows in which a reversal may lie.
const LONGEST_GAP: f64 = 3.0;
/// A larger step between samples, over the range, is a gap; 12 samples of a sine have steps of 0.26.
const LARGEST_STEP: f64 = 0.25;
/// Number of equal extreme values, over the number of samples, that a saturated sensor has.
const CLIPPED: f64 = 0.02;
impl Record {
    pub fn new(measurement: &Measurement, index: usize, normal_force: f64) -> Result<Record, Error> {
        let name = match measurement.name.as_str() {
            "" => format!("measurement {}", index + 1),
            name => name.to_owned(),
        };
        let fail = |reason: String| error(format!("{name}: {reason}"));
        let count = measurement.displacement.len();
        let normal_force = match &measurement.normal_force {
            Some(NormalForce::Samples(samples)) => samples.clone(),
            Some(NormalForce::Constant(value)) => vec![*value; count],
            None => vec![normal_force; count],
        };
        let has_time = measurement.time.is_some();
        let time = measurement.time.clone().unwrap_or_else(|| (0..count).map(|i| i as f64).collect());
        // Rows of the measurement, for messages about samples that are left when others were left out.
        let rows = (1..=count).map(|row| row as f64).collect();
        let mut columns = [measurement.displacement.clone(), measurement.force.clone(), normal_force, time, rows];
        for (name, values) in ["displacement", "force", "normal force", "time"].into_iter().zip(&columns) {
            if values.len() != count {
                return fail(format!("{name} has {} values, displacement {count}", values.len()));
            }
        }
        let mut warnings = Vec::new();
        let mut leave_out = |columns: &mut [Vec<f64>; 5], are_left_out: &[bool], most: f64, what: &str| {
            let found = are_left_out.iter().filter(|row| **row).count();
            if found as f64 > most * are_left_out.len() as f64 {
                let first = are_left_out.iter().zip(&columns[4]).find(|(is_left_out, _)| **is_left_out);
                return error(format!(
                    "{name}: {found} of {} samples {what}, the first one is {}; at most {:.0} % are left out",
                    are_left_out.len(),
                    first.map_or(0.0, |(_, row)| *row),
                    100.0 * most
                ));
            }
            if found > 0 {
                warnings.push(format!("{name}: {found} samples are left out: they {what}"));
                for column in columns {
                    let mut rows = are_left_out.iter();
                    column.retain(|_| !rows.next().is_some_and(|is_left_out| *is_left_out));
                }
            }
            Ok(())
        };
        let are_missing: Vec<_> = (0..count).map(|i| columns.iter().any(|values| !values[i].is_finite())).collect();
        leave_out(&mut columns, &are_missing, MOST_MISSING, "have no number")?;
        if has_time && columns[3].windows(2).all(|pair| pair[1] < pair[0]) {
            columns.iter_mut().for_each(|values| values.reverse());
        }
        let is_same = |i: usize| i > 0 && columns[..4].iter().all(|values| values[i] == values[i - 1]);
        let are_doubled: Vec<_> = (0..columns[0].len()).map(|i| has_time && is_same(i)).collect();
        leave_out(&mut columns, &are_doubled, 1.0, "repeat the sample before, with its time")?;
        let [of_displacement, of_force] = [0, 1].map(|i| spikes(&columns[i]));
        let are_spikes: Vec<_> = of_displacement.iter().zip(&of_force).map(|(one, other)| *one || *other).collect();
        leave_out(&mut columns, &are_spikes, MOST_SPIKES, "are spikes")?;
        let [displacement, force, normal_force, mut time, rows] = columns;
        let count = displacement.len();
        if count < LEAST_SAMPLES {
            return fail(format!("{count} samples; a fit needs at least {LEAST_SAMPLES}"));
        }
        if let Some(i) = normal_force.iter().position(|value| *value <= 0.0) {
            return fail(format!("the normal force of sample {} is not positive: the contact is open", rows[i]));
        }
        for (column, values) in [("displacement", &displacement), ("force", &force)] {
            if range(values) == 0.0 {
                return fail(format!("{column} is constant"));
            }
            let largest = LARGEST_STEP * range(values);
            // Behind a large play the force jumps while the displacement goes on.
            let step = |i: usize| displacement.get(i + 1).map_or(0.0, |next| (next - displacement[i]).abs());
            let goes_on = |i: usize| step(i) < LONGEST_GAP * step(i.saturating_sub(1)).max(step(i + 1));
            let jumps = |i: &usize| (values[i + 1] - values[*i]).abs() > largest && (column != "force" || !goes_on(*i));
            if let Some(i) = (0..count - 1).find(jumps) {
                return fail(format!(
                    "{column} jumps by more than a quarter of its range after sample {}: samples are missing, or a cycle has \
                     fewer than 12",
                    rows[i]
                ));
            }
            if let Some(limit) = saturation(values) {
                return fail(format!(
                    "{column} is cut off at {limit:e}: many samples have exactly this extreme value, although the others are \
                     noisy; the sensor or its amplifier is saturated"
                ));
            }
        }
        let mut steps: Vec<_> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if let Some(i) = steps.iter().position(|step| *step <= 0.0) {
            warnings.push(format!(
                "{name}: time does not increase after sample {}: a coarse clock, or one that stopped or restarted; equal steps of \
                 time are assumed",
                rows[i]
            ));
            time = (0..count).map(|i| i as f64).collect();
            steps.fill(1.0);
        }
        let longest = steps.iter().enumerate().max_by(|one, other| one.1.total_cmp(other.1));
        let (i, longest) = longest.map_or((0, 0.0), |(i, step)| (i, *step));
        steps.sort_by(f64::total_cmp);
        if has_time && longest > LONGEST_GAP * steps[steps.len() / 2] {
            return fail(format!(
                "a gap of {longest:e} in time after sample {}: use the part before or after it, with at least one cycle",
                rows[i]
            ));
        }
        let length = time[count - 1] - time[0];
        let (interval, step) = (1.0, length / (count - 1) as f64);
        let time = time.iter().map(|at| 2.0 * (at - time[0]) / length - 1.0).collect();
        let (noise, normal_force) = ([noise(&displacement), noise(&force)], smoothed(&normal_force));
        let resolution = resolution(&force);
        Ok(Record { name, time, displacement, force, normal_force, noise, resolution, interval, step, warnings })
    }

    /// The same record with other columns.
    fn map(&self, of: impl Fn(&[f64]) -> Vec<f64>) -> Record {
        let [time, displacement, force] = [&self.time, &self.displacement, &self.force].map(|column| of(column));
        Record {
            name: self.name.clone(),
            time,
            displacement,
            force,
            normal_force: of(&self.normal_force),
            warnings: Vec::new(),
            ..*self
        }
    }

    /// The same record with a displacement from which its regression line over the time is removed.
    pub fn without_trend(&self) -> Record {
        let pairs = || self.time.iter().copied().zip(self.displacement.iter().copied());
        let [time, centre, slope] = regression(pairs());
        Record { displacement: pairs().map(|(t, x)| x - centre - slope * (t - time)).collect(), ..self.clone() }
    }

    /// Means of the given number of successive samples.
    pub fn averaged(&self, samples: usize) -> Record {
        let mean = |part: &[f64]| mean(part.iter().copied());
        let record = self.map(|values| values.chunks_exact(samples).map(mean).collect());
        let noise = [noise(&record.displacement), noise(&record.force)];
        let [interval, step] = [self.interval, self.step].map(|size| size * samples as f64);
        Record { noise, interval, step, ..record }
    }

    /// The samples before `end` from another one on, which is repeated at the end, if they end where they start.
    pub fn rotated(&self, start: usize, end: usize) -> Record {
        self.map(|values| [&values[start..end], &values[..=start]].concat())
    }
}

pub(crate) fn range(values: &[f64]) -> f64 {
    let [low, high] = ends(values.iter().copied());
    high - low
}

/// The least and the largest value.
pub(crate) fn ends(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

pub(crate) fn mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count();
    values.sum::<f64>() / count.max(1) as f64
}

/// Means of both values of pairs, and the slope of the second over the first by least squares.
pub(crate) fn regression(pairs: impl Iterator<Item = (f64, f64)> + Clone) -> [f64; 3] {
    let [x, y] = [mean(pairs.clone().map(|pair| pair.0)), mean(pairs.clone().map(|pair| pair.1))];
    let covariance = mean(pairs.clone().map(|pair| (pair.0 - x) * (pair.1 - y)));
    [x, y, covariance / mean(pairs.map(|pair| (pair.0 - x).powi(2))).max(f64::MIN_POSITIVE)]
}

/// Parabola through five samples by least squares (Savitzky and Golay).
pub(crate) fn smoothed(values: &[f64]) -> Vec<f64> {
    let mut result = values.to_vec();
    for (value, near) in result[2..].iter_mut().zip(values.windows(5)) {
        *value = (17.0 * near[2] + 12.0 * (near[1] + near[3]) - 3.0 * (near[0] + near[4])) / 35.0;
    }
    result
}

/// Standard deviation of white noise, from fourth differences. Their smallest three quarters are used: the kinks of a loop are in
/// the others. Of normally distributed numbers these have 0.6071 of the standard deviation.
fn noise(values: &[f64]) -> f64 {
    let fourth = |near: &[f64]| near[0] + near[4] - 4.0 * (near[1] + near[3]) + 6.0 * near[2];
    let mut squares: Vec<_> = values.windows(5).map(|near| fourth(near).powi(2)).collect();
    squares.sort_by(f64::total_cmp);
    let kept = &squares[..squares.len() * 3 / 4];
    // The sum of the squares of 1, 4, 6, 4, 1.
    (kept.iter().sum::<f64>() / kept.len() as f64 / 70.0).sqrt() / 0.6071
}

/// Which samples are spikes.
fn spikes(values: &[f64]) -> Vec<bool> {
    let (mut found, [factor, sigmas], noise) = (vec![false; values.len()], SPIKE, noise(values));
    for (i, near) in values.windows(7).enumerate() {
        let step = |k: usize| near[k + 1] - near[k];
        let others = [0, 1, 4, 5].map(|k| step(k).abs()).into_iter().fold((near[4] - near[2]).abs(), f64::max);
        let height = step(2).abs().min(step(3).abs());
        found[i + 3] = step(2) * step(3) < 0.0 && height > (factor * others).max(sigmas * noise);
    }
    found
}

/// Smallest difference of two values that is not rounding of the last digits.
fn resolution(values: &[f64]) -> f64 {
    let (mut sorted, least) = (values.to_vec(), 1e-9 * range(values));
    sorted.sort_by(f64::total_cmp);
    sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > least).fold(f64::INFINITY, f64::min)
}

/// The value of a plateau of a saturated sensor: many samples have exactly the largest or smallest value, but neighbours elsewhere
/// differ, so that it is no resolution of the sensor, and there is noise, so that it is no computed loop.
fn saturation(values: &[f64]) -> Option<f64> {
    let count = |is: &dyn Fn(f64, f64) -> bool| values.windows(2).filter(|pair| is(pair[0], pair[1])).count();
    let [low, high] = ends(values.iter().copied());
    let least = (CLIPPED * values.len() as f64).max(5.0) as usize;
    // Noise separates four equal values of a digitiser, but not of a saturated sensor.
    let clipped = [low, high].map(|end| values.windows(4).filter(|near| near.iter().all(|at| *at == end)).count());
    let equal_elsewhere = count(&|one, other| one == other && one != low && one != high);
    // Rounding to steps has 0.29 of a step as its standard deviation.
    let least_noise = (1e-5 * (high - low)).max(0.5 * resolution(values));
    let noisy = noise(values) > least_noise && 20 * equal_elsewhere < values.len();
    let end = [low, high].into_iter().zip(clipped).find(|(_, clipped)| *clipped >= least);
    end.filter(|_| noisy).map(|(end, _)| end)
}
