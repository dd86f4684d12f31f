//! Times a frame that is only cleared: the id and the distance of every pixel are written once.
//!
//! `cargo bench --bench memory_fill -- WxH THREADS REPEAT` prints the median, the shortest and the longest time in
//! milliseconds, as `report.json` gives them. No renderer that writes buffers of this size can be faster.
//! [`Frame::clear`] does the same on one thread.

use bothways::common::frame::NO_PRIMITIVE;
use bothways::common::{Camera, Frame, Options};
use bothways::orders::Spread;
use rayon::prelude::*;
use std::process::ExitCode;
use std::time::Instant;

/// Rows that a thread fills at a time.
const ROWS: usize = 64;

fn main() -> ExitCode {
    // Cargo adds the argument `--bench`.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let Some(([width, height], threads, repeat)) = read(&words) else {
        eprintln!("give WxH THREADS REPEAT, such as 1920x1080 2 15, and not {:?}", words.join(" "));
        return ExitCode::from(2);
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let mut frame = Frame::new(&Camera::canonical(height, width), &Options::default());
    let times = pool.expect("there are threads").install(|| {
        fill(&mut frame);
        let timed = |_| {
            let start = Instant::now();
            fill(&mut frame);
            start.elapsed().as_secs_f64() * 1e3
        };
        (0..repeat).map(timed).collect()
    });
    let Spread { median, min, max } = Spread::of(times);
    println!(r#"{{ "median": {median}, "min": {min}, "max": {max} }}"#);
    ExitCode::SUCCESS
}

/// Reads the size, the threads and the repetitions; without arguments they are 1920x1080, 1 and 15.
fn read(words: &[String]) -> Option<([u32; 2], usize, u32)> {
    let [size, threads, repeat] = match words {
        [] => ["1920x1080", "1", "15"],
        [size, threads, repeat] => [size, threads, repeat].map(String::as_str),
        _ => return None,
    };
    let (width, height) = size.split_once('x')?;
    let size = [width.parse().ok()?, height.parse().ok()?];
    let within = size.into_iter().all(|side| (1..=16_384).contains(&side));
    let (threads, repeat) = (threads.parse().ok()?, repeat.parse().ok()?);
    (within && (1..=1024).contains(&threads) && repeat > 0).then_some((size, threads, repeat))
}

/// Clears a frame in parallel.
fn fill(frame: &mut Frame) {
    let columns = frame.width();
    frame.tiles_mut(ROWS, columns).into_par_iter().for_each(|tile| {
        tile.ids.narrow().into_iter().for_each(|row| row.fill(NO_PRIMITIVE));
        tile.t.into_iter().for_each(|row| row.fill(f32::INFINITY));
    });
}
