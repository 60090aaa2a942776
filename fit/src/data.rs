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
}

/// Samples that a record needs at least.
const LEAST_SAMPLES: usize = 40;
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
        let Measurement { displacement, force, time, .. } = measurement;
        let count = displacement.len();
        let normal_force = &match &measurement.normal_force {
            Some(NormalForce::Samples(samples)) => samples.clone(),
            Some(NormalForce::Constant(value)) => vec![*value; count],
            None => vec![normal_force; count],
        };
        let columns = [("displacement", displacement), ("force", force), ("normal force", normal_force)];
        for (column, values) in columns.into_iter().chain(time.iter().map(|time| ("time", time))) {
            if values.len() != count {
                return fail(format!("{column} has {} values, displacement {count}", values.len()));
            }
            if let Some(row) = values.iter().position(|value| !value.is_finite()) {
                return fail(format!("{column} of sample {} is not a number", row + 1));
            }
        }
        if count < LEAST_SAMPLES {
            return fail(format!("{count} samples; a fit needs at least {LEAST_SAMPLES}"));
        }
        if let Some(row) = normal_force.iter().position(|value| *value <= 0.0) {
            return fail(format!("the normal force of sample {} is not positive: the contact is open", row + 1));
        }
        for (column, values) in &columns[..2] {
            if range(values) == 0.0 {
                return fail(format!("{column} is constant"));
            }
            let largest = LARGEST_STEP * range(values);
            if let Some(row) = values.windows(2).position(|pair| (pair[1] - pair[0]).abs() > largest) {
                return fail(format!(
                    "{column} jumps by more than a quarter of its range after sample {}: samples are missing, or a cycle has \
                     fewer than 12",
                    row + 1
                ));
            }
            if let Some(limit) = saturation(values) {
                return fail(format!(
                    "{column} is cut off at {limit:e}: many samples have exactly this extreme value, although the others are \
                     noisy; the sensor or its amplifier is saturated"
                ));
            }
        }
        if let Some(time) = time {
            let mut steps: Vec<_> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
            if let Some(row) = steps.iter().position(|step| *step <= 0.0) {
                return fail(format!("time does not increase after sample {}", row + 1));
            }
            let longest = steps.iter().enumerate().max_by(|one, other| one.1.total_cmp(other.1));
            let (row, longest) = longest.map_or((0, 0.0), |(row, step)| (row, *step));
            steps.sort_by(f64::total_cmp);
            if longest > 3.0 * steps[steps.len() / 2] {
                return fail(format!("a gap of {longest:e} in time after sample {}", row + 1));
            }
        }
        let index: Vec<_> = (0..count).map(|i| i as f64).collect();
        let time = time.as_ref().unwrap_or(&index);
        let length = time[count - 1] - time[0];
        let (interval, step) = (1.0, length / (count - 1) as f64);
        let time = time.iter().map(|at| 2.0 * (at - time[0]) / length - 1.0).collect();
        let noise = [noise(displacement), noise(force)];
        let (displacement, force, normal_force) = (displacement.clone(), force.clone(), smoothed(normal_force));
        let resolution = resolution(&force);
        Ok(Record { name, time, displacement, force, normal_force, noise, resolution, interval, step })
    }

    /// The same record with other columns.
    fn map(&self, of: impl Fn(&[f64]) -> Vec<f64>) -> Record {
        let [time, displacement, force] = [&self.time, &self.displacement, &self.force].map(|column| of(column));
        Record { name: self.name.clone(), time, displacement, force, normal_force: of(&self.normal_force), ..*self }
    }

    /// Means of the given number of successive samples.
    pub fn averaged(&self, samples: usize) -> Record {
        let mean = |part: &[f64]| part.iter().sum::<f64>() / samples as f64;
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
    let [low, high] = ends(values);
    high - low
}

fn ends(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(*value), high.max(*value)])
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
    let [low, high] = ends(values);
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
