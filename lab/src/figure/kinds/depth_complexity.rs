//! How many primitives cover each sample, and how often each number occurs.

use super::counts::{Counted, Counts, heat_map, scale_bar};
use crate::common::Options;
use crate::figure::drawing::{Anchor, Drawing, Ink};
use crate::figure::sheet::{MARGIN, RIGHT, Sheet, TOP, number};
use crate::figure::subject::{FigureError, Subject};
use crate::figure::theme::ramp;
use crate::rasterize;
use crate::wording::grouped;

/// The rooms of the map and of the histogram.
const MAP: ([f64; 2], [f64; 2]) = ([MARGIN, TOP + 44.0], [1030.0, 690.0]);
const BARS: ([f64; 2], [f64; 2]) = ([1180.0, TOP + 44.0], [RIGHT - 1180.0, 690.0]);
/// The most bars of the histogram; the last one stands for all greater numbers.
const MOST_BARS: usize = 16;

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let options = Options::default();
    let mut counts = Counts::new(subject.view.camera.image(), Counted::Fragments);
    let prepared = rasterize::fast::prepare(subject.view.scene);
    let mut frame = crate::common::Frame::new(subject.view.camera, &options);
    rasterize::fast::determine_visibility(
        &prepared,
        &subject.view,
        &options,
        &mut frame,
        &mut counts,
    );
    let point = "Depth complexity: how many primitives lie behind one another at a sample, a sphere once. Only the nearest is seen.";
    let mut sheet = Sheet::new(subject, "How many primitives cover each sample?", point);
    let (image, counts): ([usize; 2], Vec<u64>) = (counts.size(), counts.all().collect());
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let (corner, size) = MAP;
    let mean = counts.iter().sum::<u64>() as f64 / counts.len() as f64;
    let drawn = heat_map(&mut sheet, (image, &counts), corner, size, |count| shade(count, most));
    let note = format!("mean {}", number(mean, 3));
    sheet.heading(corner, drawn[0].max(560.0), "primitives that cover the sample", &note);
    scale_bar(&mut sheet, [corner[0], corner[1] + drawn[1] + 16.0], drawn[0], &[0, most]);
    histogram(&mut sheet, &counts, most);
    Ok(sheet.drawing)
}

/// The place on the ramp of a number of primitives.
fn shade(count: u64, most: u64) -> f64 {
    count as f64 / most as f64
}

fn histogram(sheet: &mut Sheet, counts: &[u64], most: u64) {
    let theme = sheet.theme;
    let (corner, size) = BARS;
    sheet.heading(corner, size[0], "how often", "samples");
    let bars = usize::try_from(most).unwrap_or(usize::MAX).min(MOST_BARS - 1) + 1;
    let mut samples = vec![0_u64; bars];
    for count in counts.iter().copied() {
        samples[usize::try_from(count).unwrap_or(usize::MAX).min(bars - 1)] += 1;
    }
    let greatest = samples.iter().copied().max().unwrap_or(1).max(1);
    let step = (size[1] / bars as f64).min(64.0);
    for (count, samples) in samples.iter().enumerate() {
        let y = corner[1] + count as f64 * step;
        let more = count + 1 == bars && most >= bars as u64;
        let name = if more { format!("≥ {count}") } else { count.to_string() };
        let baseline = y + 0.62 * step;
        let label = theme.text().tabular().sized(if step < 40.0 { 19.0 } else { 24.0 });
        sheet.drawing.text([corner[0] + 58.0, baseline], Anchor::Right, &name, label);
        let room = size[0] - 76.0 - 130.0;
        let length =
            (room * *samples as f64 / greatest as f64).max(if *samples > 0 { 2.0 } else { 0.0 });
        let color = ramp(shade(count as u64, most));
        let bar = [corner[0] + 76.0, y + 0.16 * step];
        sheet.drawing.rectangle(
            [bar[0] - 1.0, bar[1] - 1.0],
            [length + 2.0, 0.68 * step + 2.0],
            Ink::new(theme.hairline()),
        );
        sheet.drawing.rectangle(bar, [length, 0.68 * step], Ink::new(color));
        let figure = grouped(*samples);
        let at = [bar[0] + length + 14.0, baseline];
        sheet.drawing.text(at, Anchor::Left, &figure, label.of(theme.quiet()));
    }
}
