//! Reversals and cycles of a record, and its loops: cycles of equal amplitude without offset and drift of the displacement.

use crate::data::{Record, mean, range, regression, smoothed};
use crate::error::{Error, error};

/// Cycles of one record and one amplitude.
#[derive(Debug, Clone)]
pub(crate) struct Loop {
    pub name: String,
    /// Mean normal force.
    pub normal_force: f64,
    /// Half range of the displacement, from the reversals.
    pub amplitude: f64,
    /// Standard error of the displacement of a reversal.
    pub reversal_error: f64,
    /// Standard deviation of the noise of displacement and force.
    pub noise: [f64; 2],
    /// Step of the digitiser of the force.
    pub resolution: f64,
    /// Samples of the measurement in one sample.
    pub interval: f64,
    /// Whether there are cycles enough to distinguish a drift from the loop.
    pub has_drift: bool,
    /// Number of complete cycles, and of the samples that they have.
    pub cycles: usize,
    pub complete: usize,
    pub samples: Vec<Sample>,
}

/// A sample on a branch from a reversal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    /// As a fraction of the record, -1 to 1.
    pub time: f64,
    /// Displacement from the middle of the loop.
    pub displacement: f64,
    pub force: f64,
    /// Normal force less its mean: of the sample, and of the reversal.
    pub load_excess: f64,
    pub load_excess_at_reversal: f64,
    /// +1 if the displacement grows, otherwise -1.
    pub direction: f64,
    /// Distance from the reversal.
    pub distance: f64,
    /// Displacement per unit of time, or per sample of the measurement without times.
    pub velocity: f64,
}

/// Amplitudes that differ by less, as a fraction, belong to the same loop.
const EQUAL_AMPLITUDE: f64 = 0.05;
/// Smallest cycle, over the range of the displacement, that is not noise.
const SMALLEST_CYCLE: f64 = 0.1;
/// Displacement and force of a record that ends where it starts differ by less than this fraction of their ranges.
const CLOSED: f64 = 0.1;
/// The largest swing of the normal force about its mean that the law for a constant one admits: its effect is included to first
/// order, so that an error of its square, a percent of the force, remains.
const LARGEST_SWING: f64 = 0.1;
/// Least ratio of the relative areas of a loop of gross slip and of a loop without, which a lag of some samples makes negative.
const OPEN: f64 = 4.0;

/// Steps of force in which a play is looked for, and the least part of the displacement in them that is a play.
const LEVELS: usize = 24;
const PLAY: f64 = 0.3;
/// Samples of a branch; of more, successive ones are averaged.
const SAMPLES: usize = 250;
/// A rest at a reversal: within this fraction of the range for more than this fraction of a branch. A sine stays there for 0.09.
const REST: [f64; 2] = [5e-3, 0.2];

/// The loops of a record; if it has none, without the trend of its displacement, which may hide cycles.
pub(crate) fn loops(record: &Record) -> Result<Vec<Loop>, Error> {
    loops_of(record).or_else(|error| loops_of(&record.without_trend()).map_err(|_| error))
}

fn loops_of(original: &Record) -> Result<Vec<Loop>, Error> {
    let mut record = original;
    let (count, fail) = (record.time.len(), |reason: &str| error(format!("{}: {reason}", record.name)));
    let least = |record: &Record| SMALLEST_CYCLE * range(&record.displacement) + 6.0 * record.noise[0];
    let mut reversals = reversals(&smoothed(&record.displacement), least(record));
    let rotated;
    if reversals.len() < 3 {
        let end = reversals.first().map_or(count, |first| first_cycle(&record.displacement, *first, record.noise[0]));
        let is_closed = |values: &[f64]| (values[end - 1] - values[0]).abs() <= CLOSED * range(values);
        if reversals.is_empty() || !is_closed(&record.displacement) || !is_closed(&record.force) {
            return fail("less than one cycle: record from one reversal to the next but one, or a closed loop");
        }
        let highest = (0..end).max_by(|i, j| record.displacement[*i].total_cmp(&record.displacement[*j]));
        rotated = record.rotated(highest.unwrap_or_default(), end);
        record = &rotated;
        reversals = [vec![0], self::reversals(&smoothed(&record.displacement), least(record)), vec![end]].concat();
    }
    let branch = (reversals[reversals.len() - 1] - reversals[0]) / (reversals.len() - 1);
    if branch >= 2 * SAMPLES {
        return loops_of(&original.averaged(branch / SAMPLES));
    }
    let displacement = smoothed(&record.displacement);
    let half_range = |i: usize| 0.5 * (displacement[reversals[i + 1]] - displacement[reversals[i]]).abs();
    let (mut loops, mut first) = (Vec::new(), 0);
    while first + 2 < reversals.len() {
        let equal = |i: &usize| {
            (half_range(*i) - half_range(first)).abs() <= EQUAL_AMPLITUDE * half_range(first) + 4.0 * record.noise[0]
        };
        let last = (first..reversals.len() - 1).take_while(equal).last().unwrap_or(first) + 1;
        if last >= first + 2 {
            // The rest of the record follows the same loop.
            let end = if last + 1 == reversals.len() { record.time.len() } else { reversals[last] };
            loops.push(Loop::new(record, &displacement, &reversals[first..=last], end));
        }
        first = last;
    }
    if loops.is_empty() {
        return fail(
            "the amplitude changes by more than 5 % from each reversal to the next: no loop is closed; hold an amplitude for at least \
             one cycle",
        );
    }
    let swing = loops.iter().map(Loop::swing).fold(0.0, f64::max);
    if swing > LARGEST_SWING {
        return fail(&format!(
            "the normal force varies by {:.0} % about its mean; the law for a constant normal force admits 10 %. Measure under a \
             steady load, or compare with `microslip history --normal-force-column`",
            100.0 * swing
        ));
    }
    Ok(loops)
}

/// Indices of the local extremes between which the displacement changes by more than `least`; without those at the ends.
fn reversals(displacement: &[f64], least: f64) -> Vec<usize> {
    let (mut found, mut low, mut high, mut direction) = (Vec::new(), 0, 0, 0.0);
    for (i, &value) in displacement.iter().enumerate() {
        low = if value < displacement[low] { i } else { low };
        high = if value > displacement[high] { i } else { high };
        let [fall, rise] = [displacement[high] - value, value - displacement[low]];
        if direction <= 0.0 && rise > least {
            // The start of the record is no reversal.
            found.extend((direction < 0.0).then_some(low));
            (direction, high) = (1.0, i);
        } else if direction >= 0.0 && fall > least {
            found.extend((direction > 0.0).then_some(high));
            (direction, low) = (-1.0, i);
        }
    }
    found
}

/// The number of samples before the second cycle of a record whose first reversal is given; that of all if the record has less.
fn first_cycle(displacement: &[f64], first: usize, noise: f64) -> usize {
    let (values, count) = (smoothed(displacement), displacement.len());
    let above = |i: &usize| (values[*i] - values[0]) * (values[0] - values[first]).signum();
    let top = |from: usize, to: usize| (from..to).max_by(|i, j| above(i).total_cmp(&above(j))).unwrap_or(first);
    // Whether the record starts before a reversal that is too close to its start to be found: farther from there than by noise, in
    // six standard deviations.
    let before = above(&top(0, first)) > 6.0 * noise;
    let from = if before { first } else { top(first, count) + 1 };
    (from..count).find(|i| if before { above(i) >= 0.0 } else { above(i) <= 0.0 }).unwrap_or(count)
}

impl Loop {
    fn new(record: &Record, smooth: &[f64], reversals: &[usize], end: usize) -> Loop {
        let samples = reversals[0]..end;
        let has_drift = reversals.len() > 4;
        // Drift of the middle between two reversals.
        let middle = |pair: &[usize]| {
            let [time, displacement] = [&record.time[..], smooth].map(|of| 0.5 * (of[pair[0]] + of[pair[1]]));
            (time, displacement)
        };
        let [time, centre, slope] = regression(reversals.windows(2).map(middle));
        let drift = if has_drift { slope } else { 0.0 };
        // Drift of the mean force of a branch to the next but one.
        let of_branch = |pair: &[usize]| {
            let [time, force] = [&record.time, &record.force].map(|of| mean(of[pair[0]..pair[1]].iter().copied()));
            (time, force)
        };
        let branches: Vec<_> = reversals.windows(2).map(of_branch).collect();
        let changes = branches.iter().zip(branches.iter().skip(2)).map(|(one, next)| [next.0 - one.0, next.1 - one.1]);
        let [of_time, of_force] = [0, 1].map(|i| changes.clone().map(|change| change[i]).sum::<f64>());
        let force_drift = if has_drift { of_force / of_time } else { 0.0 };
        let steady = |values: &[f64], i: usize| values[i] - centre - drift * (record.time[i] - time);

        // Ends of the loop; each reversal is drawn to their mean as far as it differs by noise only.
        let is_high = |k: usize| smooth[reversals[k]] > smooth[reversals[if k == 0 { 1 } else { k - 1 }]];
        let of_end = |high: bool| (0..reversals.len()).filter(move |k| is_high(*k) == high);
        let ends = [false, true].map(|high| mean(of_end(high).map(|k| steady(smooth, reversals[k]))));
        let scatter = |k: usize| (steady(smooth, reversals[k]) - ends[usize::from(is_high(k))]).powi(2);
        let degrees = reversals.len().saturating_sub(2).max(1) as f64;
        let variance = (0..reversals.len()).map(scatter).sum::<f64>() / degrees;
        let true_part = 1.0 - (record.noise[0].powi(2) / variance.max(f64::MIN_POSITIVE)).min(1.0);
        let start = |k: usize| {
            let mean = ends[usize::from(is_high(k))];
            mean + true_part * (steady(smooth, reversals[k]) - mean)
        };
        let step = |k: &usize| {
            let neighbours = [k.saturating_sub(1), (k + 1).min(smooth.len() - 1)];
            0.5 * neighbours.map(|i| (smooth[i] - smooth[*k]).abs()).iter().sum::<f64>()
        };
        let reversal_error = record.noise[0] + 0.5 * mean(reversals.iter().map(step));

        // At rest the force may creep, which is no part of the law.
        let mut rests = vec![false; smooth.len()];
        for &reversal in reversals {
            let at_rest = |i: &usize| (smooth[*i] - smooth[reversal]).abs() <= REST[0] * (ends[1] - ends[0]);
            let from = (samples.start..=reversal).rev().take_while(at_rest).last().unwrap_or(reversal);
            let to = (reversal..end).take_while(at_rest).last().unwrap_or(reversal);
            let length = (reversals[reversals.len() - 1] - samples.start) as f64 / (reversals.len() - 1) as f64;
            rests[from..=to].fill((to - from) as f64 > REST[1] * length);
        }

        let normal_force = mean(samples.clone().map(|i| record.normal_force[i]));
        let velocity = |i: usize| {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(smooth.len() - 1));
            (smooth[after] - smooth[before]) / (record.step * (after - before) as f64)
        };
        let mut branch = 0;
        let sample = |i: usize| {
            while branch + 1 < reversals.len() && i >= reversals[branch + 1] {
                branch += 1;
            }
            let (displacement, direction) = (steady(&record.displacement, i), if is_high(branch) { -1.0 } else { 1.0 });
            Sample {
                time: record.time[i],
                displacement,
                force: record.force[i] - force_drift * (record.time[i] - time),
                load_excess: record.normal_force[i] - normal_force,
                load_excess_at_reversal: record.normal_force[reversals[branch]] - normal_force,
                direction,
                distance: direction * (displacement - start(branch)),
                velocity: velocity(i),
            }
        };
        let last = reversals[2 * ((reversals.len() - 1) / 2)];
        Loop {
            name: record.name.clone(),
            normal_force,
            amplitude: 0.5 * (ends[1] - ends[0]),
            reversal_error,
            noise: record.noise,
            resolution: record.resolution,
            interval: record.interval,
            has_drift,
            cycles: (reversals.len() - 1) / 2,
            complete: (samples.start..end.min(last + 1)).filter(|i| !rests[*i]).count(),
            samples: samples.filter(|i| !rests[*i]).map(sample).collect(),
        }
    }

    /// The size of a play and the forces between which it is crossed, without a model: along a branch of the law the compliance
    /// never decreases, in a play it does so at the end. `None` if no branch crosses all levels of force, or none has a play.
    pub fn play(&self) -> Option<(f64, [f64; 2])> {
        let [low, high] = self.force_range();
        let level = |k: usize| low + (high - low) * (k as f64 + 1.0) / (LEVELS as f64 + 2.0);
        let (mut excess, mut steps, mut branches) = ([0.0; LEVELS], [0.0; LEVELS], 0.0);
        for branch in self.samples.chunk_by(|one, next| one.direction == next.direction) {
            let sign = branch[0].direction;
            let place = |k: usize| if sign > 0.0 { k } else { LEVELS - k };
            // The displacement at which the force first passes a level.
            let passes = |k: usize| {
                let force = level(place(k));
                let next = branch.iter().position(|sample| sign * (sample.force - force) >= 0.0)?;
                let [before, after] = [&branch[next.checked_sub(1)?], &branch[next]];
                let part = (force - before.force) / (after.force - before.force);
                Some(before.distance + part * (after.distance - before.distance))
            };
            let Some(distances) = (0..=LEVELS).map(passes).collect::<Option<Vec<_>>>() else { continue };
            let mut least = f64::INFINITY;
            for k in (0..LEVELS).rev() {
                let step = distances[k + 1] - distances[k];
                least = least.min(step);
                let place = place(k).min(place(k + 1));
                (excess[place], steps[place]) = (excess[place] + step - least, steps[place] + step);
            }
            branches += 1.0;
        }
        // The levels around the one with the largest excess.
        let most = (0..LEVELS).max_by(|i, j| excess[*i].total_cmp(&excess[*j]))?;
        let is_in = |k: &usize| excess[*k] > 0.1 * excess[most];
        let first = (0..most).rev().take_while(is_in).last().unwrap_or(most);
        let last = (most..LEVELS).take_while(is_in).last().unwrap_or(most);
        let [size, whole] = [&excess, &steps].map(|of| of[first..=last].iter().sum::<f64>() / branches);
        (size > PLAY * whole).then_some((size, [level(first), level(last + 1)]))
    }

    /// The loop without a play, and without the samples in it, between these forces.
    pub fn without_play(&self, play: f64, [low, high]: [f64; 2]) -> Loop {
        let sample = |sample: &Sample| {
            let crossed = 0.5 * play * if sample.force > high { 1.0 } else { -1.0 };
            Sample {
                displacement: sample.displacement - crossed,
                // From the reversal, on the other side.
                distance: sample.distance - sample.direction * crossed - 0.5 * play,
                ..*sample
            }
        };
        let samples =
            self.samples.iter().filter(|sample| sample.force < low || sample.force > high).map(sample).collect();
        Loop { amplitude: self.amplitude - 0.5 * play, samples, ..self.clone() }
    }

    /// Energy per cycle over that of the rectangle around the loop.
    fn area(&self) -> f64 {
        let forces: Vec<_> = self.samples.iter().map(|sample| sample.force).collect();
        self.energy(&forces) / (range(&forces) * 2.0 * self.amplitude)
    }

    /// Checks the direction of the loop. If another loop has a positive area that is much larger, the force is late by some
    /// samples, which is left to the fit.
    pub fn check_direction(&self, loops: &[Loop]) -> Result<(), Error> {
        let area = self.area();
        if area > -0.01 || loops.iter().any(|one| one.area() > -OPEN * area) {
            return Ok(());
        }
        let [.., slope] = regression(self.samples.iter().map(|sample| (sample.displacement, sample.force)));
        let reason = if slope > 0.0 {
            "the columns of displacement and force are swapped, the rows are in reverse order, or the force is late"
        } else {
            "the sign of displacement or force is reversed; the force must resist the displacement that it is plotted against, and \
             grow with it"
        };
        error(format!("{}: the loop has a negative energy: {reason}", self.name))
    }

    /// Amplitude of the normal force over its mean.
    pub fn swing(&self) -> f64 {
        mean(self.samples.iter().map(|sample| 2.0 * sample.load_excess.powi(2))).sqrt() / self.normal_force
    }

    /// Half the range of the force, without outliers.
    pub fn height(&self) -> f64 {
        let [low, high] = self.force_range();
        0.5 * (high - low)
    }

    /// The least and the largest force, without outliers.
    pub fn force_range(&self) -> [f64; 2] {
        let mut forces: Vec<_> = self.samples.iter().map(|sample| sample.force).collect();
        forces.sort_by(f64::total_cmp);
        [2, 98].map(|percent| forces[(forces.len() - 1) * percent / 100])
    }

    /// Energy per complete cycle of forces at the samples. A constant force does no work in a cycle.
    pub fn energy(&self, forces: &[f64]) -> f64 {
        let steps = self.samples[..self.complete].windows(2).zip(forces.windows(2));
        let work = |(pair, force): (&[Sample], &[f64])| {
            0.5 * (force[0] + force[1]) * (pair[1].displacement - pair[0].displacement)
        };
        steps.map(work).sum::<f64>() / self.cycles as f64
    }
}
