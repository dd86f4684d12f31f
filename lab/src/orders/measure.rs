//! The common path of all rendering: it counts the work, measures times and reports progress.

use super::counts::{Counting, Counts};
use super::drawing::Drawing;
use super::options::RenderOptions;
use super::renderer::Renderer;
use super::times::{Spread, Times, timed};
use crate::common::{Executed, Frame, Scene};
use crate::progress::Steps;
use std::time::{Duration, Instant};

/// The preparation is repeated as often as a frame, but not after this much time.
const PREPARE_BUDGET: Duration = Duration::from_secs(2);
/// Work that takes no longer than this is done twice for one measured time: the first run warms up memory and caches.
const WARM_UP_BUDGET: Duration = Duration::from_millis(200);

/// The number of frames: one frame for the count of the work, one frame for the warm-up, and the timed frames. Without
/// times, one more frame is drawn where none is counted, or where it is cheap and tells what a frame executes.
pub(super) fn frames(options: &RenderOptions, counting: &Counting, is_cheap: bool) -> u64 {
    let counted = counting.frames();
    if options.no_times {
        return counted + u64::from(counted == 0 || is_cheap);
    }
    counted + options.repeat.map_or(1, |repeat| 1 + u64::from(repeat))
}

/// What [`measure`] finds out.
pub(super) struct Measured {
    pub(super) frame: Frame,
    pub(super) work: Counts,
    pub(super) executed: Option<Executed>,
    pub(super) times: Option<Times>,
}

/// Draws all frames of the value that `begin` prepares; their number is that of [`frames`]. `begin` also returns the time
/// of the preparation.
pub(super) fn measure<D: Drawing>(
    options: &RenderOptions,
    counting: &Counting,
    frames: u64,
    steps: &Steps,
    begin: impl FnOnce() -> (D, Spread),
) -> Result<Measured, D::Error> {
    steps.preparing();
    let (mut drawing, prepare) = begin();

    steps.frames_done(0);
    let work = counting.count(|work| drawing.draw(work, steps))?;
    steps.frames_done(counting.frames());

    let mut executed = None;
    if options.no_times {
        if frames > counting.frames() {
            executed = drawing.draw(&mut (), steps)?;
            steps.frames_done(frames);
        }
        drawing.shade();
        return Ok(Measured { frame: drawing.into_frame(), work, executed, times: None });
    }
    let mut is_warm_up = options.repeat.is_some();
    let run = |phase| {
        match phase {
            // What a frame executes is told of one whose tiles do not depend on the number of threads. The frames after it
            // are cut for the threads there are, and have a warm-up of their own.
            Phase::Visibility if std::mem::take(&mut is_warm_up) => {
                executed = drawing.draw(&mut (), steps)?;
                if drawing.cut_for_threads() {
                    drawing.draw(&mut (), steps)?;
                }
            }
            Phase::Visibility => {
                let of_this = drawing.draw(&mut (), steps)?;
                executed = executed.or(of_this);
            }
            Phase::Shading => drawing.shade(),
        }
        Ok(())
    };
    let [visibility, shading] = repeated(options.repeat, steps, run)?;
    let times = Some(Times { prepare, visibility, shading });
    Ok(Measured { frame: drawing.into_frame(), work, executed, times })
}

/// A phase of rendering a frame.
#[derive(Clone, Copy)]
pub(super) enum Phase {
    Visibility,
    Shading,
}

/// Draws the timed frames, after the frame for the count of the work. Visibility and shading are each repeated alone:
/// the programs that we compare with have no shading between two frames either.
pub(super) fn repeated<E>(
    repeat: Option<u32>,
    steps: &Steps,
    mut run: impl FnMut(Phase) -> Result<(), E>,
) -> Result<[Spread; 2], E> {
    let mut drawn = steps.frames_drawn();
    let mut spread_of = |phase| {
        // One more run for the warm-up.
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

/// Prepares a scene, and returns the time of the preparation.
pub(super) fn prepared<R: Renderer>(
    renderer: &R,
    scene: &Scene,
    options: &RenderOptions,
) -> (R::Prepared, Spread) {
    if options.no_times {
        // No clock is read: not every machine has one, WebAssembly for example.
        return (renderer.prepare(scene), Spread::default());
    }
    let begun = Instant::now();
    let (mut prepared, first) = timed(|| renderer.prepare(scene));
    // The first run is the warm-up; this also holds without `repeat`, unless a second run would take long.
    let repeat = options.repeat.unwrap_or(u32::from(begun.elapsed() < WARM_UP_BUDGET));
    if repeat == 0 {
        return (prepared, Spread::of(vec![first]));
    }
    let mut times = Vec::new();
    for _ in 0..repeat {
        // Two prepared scenes never exist at once: they take much memory.
        drop(prepared);
        let (next, time) = timed(|| renderer.prepare(scene));
        prepared = next;
        times.push(time);
        if begun.elapsed() > PREPARE_BUDGET {
            break;
        }
    }
    (prepared, Spread::of(times))
}
