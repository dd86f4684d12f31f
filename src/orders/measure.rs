//! One path for everything that is drawn: it counts the work, measures times and tells progress.

use super::counts::{Counting, Counts};
use super::drawing::Drawing;
use super::options::RenderOptions;
use super::renderer::Renderer;
use super::times::{Spread, Times, timed};
use crate::common::{Frame, Scene};
use crate::progress::Steps;
use std::time::{Duration, Instant};

/// Preparing is repeated as often as a frame, but not after this much time.
const PREPARE_BUDGET: Duration = Duration::from_secs(2);
/// Work that takes no longer than this is done twice to be timed once: the first run warms memory and caches up.
const WARM_UP_BUDGET: Duration = Duration::from_millis(200);

/// How many frames are drawn: one that counts the work, one to warm up, and the timed ones.
pub(super) fn frames(options: &RenderOptions, counting: &Counting) -> u64 {
    if options.no_times {
        return 1;
    }
    counting.frames() + options.repeat.map_or(1, |repeat| 1 + u64::from(repeat))
}

/// Draws all frames of what `begin` prepares, which also tells how long preparing took.
pub(super) fn measure<D: Drawing>(
    options: &RenderOptions,
    counting: &Counting,
    steps: &Steps,
    begin: impl FnOnce() -> (D, Spread),
) -> Result<(Frame, Counts, Option<Times>), D::Error> {
    steps.preparing();
    let (mut drawing, prepare) = begin();

    steps.frames_done(0);
    let work = counting.count(|work| drawing.draw(work, steps))?;
    steps.frames_done(counting.frames());

    if options.no_times {
        if counting.frames() == 0 {
            drawing.draw(&mut (), steps)?;
            steps.frames_done(1);
        }
        drawing.shade();
        return Ok((drawing.into_frame(), work, None));
    }
    let run = |phase| match phase {
        Phase::Visibility => drawing.draw(&mut (), steps),
        Phase::Shading => {
            drawing.shade();
            Ok(())
        }
    };
    let [visibility, shading] = repeated(options.repeat, steps, run)?;
    Ok((drawing.into_frame(), work, Some(Times { prepare, visibility, shading })))
}

/// A phase of rendering a frame.
#[derive(Clone, Copy)]
pub(super) enum Phase {
    Visibility,
    Shading,
}

/// Draws the frames that are timed, after the one in which the work was counted. Visibility and shading are each
/// repeated alone: other programs, with which ours is compared, have no shading between two frames either.
pub(super) fn repeated<E>(
    repeat: Option<u32>,
    steps: &Steps,
    mut run: impl FnMut(Phase) -> Result<(), E>,
) -> Result<[Spread; 2], E> {
    let mut drawn = steps.frames_drawn();
    let mut spread_of = |phase| {
        // One more to warm up.
        let runs = repeat.map_or(1, |repeat| u64::from(repeat) + 1);
        let mut times = Vec::new();
        for _ in 0..runs {
            let (done, time) = timed(|| run(phase));
            done?;
            times.push(time);
            if matches!(phase, Phase::Visibility) {
                drawn += 1;
                steps.frames_done(drawn);
            }
        }
        Ok(Spread::of(times.split_off(usize::from(repeat.is_some()))))
    };
    Ok([spread_of(Phase::Visibility)?, spread_of(Phase::Shading)?])
}

/// Prepares a scene, and tells how long that takes.
pub(super) fn prepared<R: Renderer>(
    scene: &Scene,
    options: &RenderOptions,
) -> (R::Prepared, Spread) {
    let begun = Instant::now();
    let (mut prepared, first) = timed(|| R::prepare(scene));
    // The first run was the warm-up; without `repeat`, too, unless a second one would take long.
    let repeat = options.repeat.unwrap_or(u32::from(begun.elapsed() < WARM_UP_BUDGET));
    if repeat == 0 || options.no_times {
        return (prepared, Spread::of(vec![first]));
    }
    let mut times = Vec::new();
    for _ in 0..repeat {
        // Never two at once: they take much memory.
        drop(prepared);
        let (next, time) = timed(|| R::prepare(scene));
        prepared = next;
        times.push(time);
        if begun.elapsed() > PREPARE_BUDGET {
            break;
        }
    }
    (prepared, Spread::of(times))
}
