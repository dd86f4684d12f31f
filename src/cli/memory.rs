//! The memory that a run needs, compared with the available memory before the work begins.

mod end;
mod limit;
mod system;

pub(super) use end::fail_where_memory_ends;
pub(super) use limit::{LimitArgs, obey};

use super::args::{BuffersArg, RenderArgs};
use super::failure::Failure;
use super::terminal;
use bothways::common::{Camera, Options};
use bothways::wording::count;
use std::path::Path;
use system::Memory;

/// The bytes of a sample in a frame: id and distance.
const BYTES_PER_SAMPLE: u64 = 4 + 4;
/// The additional bytes of a sample in a stream: id and distance of the earlier chunks, and the triangle's three
/// vertices.
const BYTES_PER_STREAMED_SAMPLE: u64 = 4 + 4 + 12;
/// The additional bytes of a sample in object order with the rules of an ordinary renderer: the depth buffer.
const BYTES_PER_RULED_SAMPLE: u64 = 8;
/// The additional bytes of a sample for `--buffers exr`: a linear colour, a normal, and its work as it is stored.
const BYTES_PER_EXR_SAMPLE: u64 = 12 + 12 + 4;
/// The bytes of a sample while its work is counted, in one order at a time.
const BYTES_PER_COUNTED_SAMPLE: u64 = 8 + 8;
/// The bytes of a pixel in the frames' pictures, and while pictures are drawn, compared and compressed: of one order, or
/// of both at once (measured with 3000 × 3000 pixels without the frames: 12).
const BYTES_PER_PIXEL: [u64; 2] = [3 + 8, 6 + 12];
/// The bytes for the program itself, and a slide, which is drawn in bands (measured with 16 × 12 pixels). The prepared
/// data of an order (clusters, a hierarchy) and the data that it keeps from frame to frame (projected vertices, bins) are
/// not counted: their size depends on the scene, and is small compared with a frame that is refused for its size.
const BYTES_FOR_THE_REST: u64 = 16 << 20;

/// The bytes for the canvas of a figure or a film, and its file.
const BYTES_FOR_A_CANVAS: u64 = 16 << 20;

/// From this number of bytes on, a run reports its memory in advance.
const MUCH: u64 = 4 << 30;

/// Refuses a run that does not fit into memory; warns about a run that needs much of the memory, or more than the
/// free memory.
pub(super) fn check(camera: &Camera, args: &RenderArgs) -> Result<(), Failure> {
    let need = Need::of(camera, args);
    let memory = Memory::read(Path::new("/"));
    need.check(&memory)?;
    if !args.output.quiet {
        terminal::warn(&need.warning(memory.free).into_iter().collect::<Vec<_>>());
        if need.bytes >= MUCH && memory.free.is_none_or(|free| need.bytes <= free) {
            anstream::eprintln!("note: {} take less", need.takes());
        }
    }
    Ok(())
}

/// Refuses pictures of both orders that do not fit into memory.
pub(super) fn check_both_orders(camera: &Camera, options: &Options) -> Result<(), Failure> {
    Need::of_both_orders(camera, options).check(&Memory::read(Path::new("/")))
}

/// The memory of all frames and pictures of a run.
#[derive(Debug)]
struct Need {
    samples: u64,
    bytes: u64,
}

impl Need {
    fn of(camera: &Camera, args: &RenderArgs) -> Need {
        let options = args.method.options();
        let pixels = options.pixels(camera.image());
        let samples = pixels.region(options.samples).area() as u64;
        let pixels = u64::from(pixels.width) * u64::from(pixels.height);
        let orders = args.method.order.orders().len();
        let streamed = if args.method.stream { BYTES_PER_STREAMED_SAMPLE } else { 0 };
        let ruled =
            if args.method.rules().object_order.is_some() { BYTES_PER_RULED_SAMPLE } else { 0 };
        let exr = args.output.buffers == BuffersArg::Exr;
        let (kept, counted) =
            if exr { (BYTES_PER_EXR_SAMPLE, BYTES_PER_COUNTED_SAMPLE) } else { (0, 0) };
        let bytes = samples * orders as u64 * (BYTES_PER_SAMPLE + streamed + kept)
            + samples * (ruled + counted)
            + pixels * BYTES_PER_PIXEL[orders - 1]
            + BYTES_FOR_THE_REST;
        Need { samples, bytes }
    }

    /// The frames and the pictures alone, and what is drawn of them.
    fn of_both_orders(camera: &Camera, options: &Options) -> Need {
        let pixels = options.pixels(camera.image());
        let samples = pixels.region(options.samples).area() as u64;
        let pixels = u64::from(pixels.width) * u64::from(pixels.height);
        let bytes = samples * 2 * BYTES_PER_SAMPLE
            + pixels * BYTES_PER_PIXEL[1]
            + BYTES_FOR_THE_REST
            + BYTES_FOR_A_CANVAS;
        Need { samples, bytes }
    }

    /// Refuses what does not fit.
    fn check(&self, memory: &Memory) -> Result<(), Failure> {
        let allowed = limit::given().map(|given| given.saturating_sub(memory.own));
        if [memory.most, allowed].into_iter().flatten().any(|most| self.bytes > most)
            || !can_be_reserved(self.bytes)
        {
            return Err(Failure::new(self.refusal(memory.most, allowed)));
        }
        Ok(())
    }

    /// The message is complete even if the limit of memory is unknown.
    fn refusal(&self, most: Option<u64>, allowed: Option<u64>) -> String {
        let (samples, need) = (count(self.samples, "samples"), in_words(self.bytes));
        let exceeds = |most: &u64| self.bytes > *most;
        // If a program may have less memory than the machine has, a limit applies (`ulimit -v`).
        let than = match (allowed.filter(exceeds), most.filter(exceeds)) {
            (Some(allowed), _) => format!("than --max-memory leaves ({})", in_words(allowed)),
            (None, Some(most)) => format!("than there is ({})", in_words(most)),
            (None, None) => "than this program may have".into(),
        };
        format!(
            "{samples} need at least {need} of memory, more {than}; take a smaller --size, a --crop of it, \
             fewer --samples, or one --order alone"
        )
    }

    /// The warning that the run may not fit, if this is possible.
    fn warning(&self, free: Option<u64>) -> Option<String> {
        let free = free.filter(|&free| self.bytes > free)?;
        let free = in_words(free);
        Some(format!(
            "only {free} are free, so the system may stop this run or grow slow: {} take less",
            self.takes()
        ))
    }

    fn takes(&self) -> String {
        let (samples, bytes) = (count(self.samples, "samples"), in_words(self.bytes));
        format!(
            "{samples} take {bytes} of memory; a smaller --size, a --crop of it, fewer --samples, or \
             one --order alone"
        )
    }
}

/// The number of gibibytes, rounded to a tenth, or of mebibytes.
fn in_words(bytes: u64) -> String {
    if bytes < 1 << 30 {
        return format!("{} MiB", bytes >> 20);
    }
    let tenths = (u128::from(bytes) * 10 + (1 << 29)) >> 30;
    format!("{}.{} GiB", tenths / 10, tenths % 10)
}

/// Whether the system can reserve this much memory at once, where addresses are limited: the system might grant one
/// frame after another, and then fail to provide the memory.
fn can_be_reserved(bytes: u64) -> bool {
    let mut all = Vec::<u8>::new();
    let fits = usize::try_from(bytes).is_ok_and(|bytes| all.try_reserve_exact(bytes).is_ok());
    // The result is used, so that the compiler does not remove the allocation.
    std::hint::black_box(&mut all);
    fits
}

#[cfg(test)]
mod tests {
    use super::*;

    const GIB: u64 = 1 << 30;

    #[test]
    fn what_is_said_has_numbers_and_remedies() {
        let need = Need { samples: 132_710_400, bytes: 8_600_000_000 };
        assert_eq!(
            need.refusal(Some(2 * GIB), None),
            "132,710,400 samples need at least 8.0 GiB of memory, more than there is (2.0 GiB); take a \
             smaller --size, a --crop of it, fewer --samples, or one --order alone"
        );
        // The memory of the machine is enough, but a limit is too low.
        assert!(
            need.refusal(Some(20 * GIB), Some(9 * GIB))
                .contains(", more than this program may have; take")
        );
        let allowed = need.refusal(Some(2 * GIB), Some(97 << 20));
        assert!(allowed.contains(", more than --max-memory leaves (97 MiB); take"), "{allowed}");
        assert_eq!(need.warning(Some(9 * GIB)), None);
        assert_eq!(
            need.warning(Some(GIB)).unwrap(),
            "only 1.0 GiB are free, so the system may stop this run or grow slow: 132,710,400 samples \
             take 8.0 GiB of memory; a smaller --size, a --crop of it, fewer --samples, or one --order \
             alone take less"
        );
    }
}
