//! `pixel`: one pixel as `bothways pixel` reports it. `neighbourhood`: the pixels around it.

use crate::answer::Answer;
use crate::camera::{Pixel, Viewpoint};
use crate::stage::Stage;
use bothways_lab::common::{Options, View};
use bothways_lab::pixel::{self, Lesson, Outline};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

#[derive(Debug, Deserialize)]
pub(crate) struct OfPixel {
    #[serde(flatten)]
    pixel: Pixel,
    #[serde(flatten)]
    from: Viewpoint,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Near {
    #[serde(flatten)]
    of: OfPixel,
    radius: u32,
}

/// The largest neighbourhood, in pixels from its middle.
const MOST_RADIUS: u32 = 64;

#[derive(Serialize)]
struct PixelJson<'a> {
    #[serde(flatten)]
    report: Lesson<'a>,
    lines: Vec<String>,
}

pub(crate) fn answer(stage: &Stage, of: &OfPixel) -> Result<Answer, String> {
    let camera = of.from.camera(&stage.loaded.camera)?;
    let Pixel { row, column } = of.pixel.check(&camera)?;
    let view = View::new(&stage.loaded.scene, &camera);
    let prepared = (&stage.rasterizer, &stage.ray_tracer);
    let samples = pixel::report_prepared(prepared, &view, &Options::default(), row, column);
    let report = Lesson {
        scene: &stage.loaded.name,
        camera: &camera,
        pixel: [row, column],
        along: 1,
        samples: &samples,
    };
    let lines = report.text().lines().map(str::to_owned).collect();
    Ok(Answer::new(PixelJson { report, lines }))
}

pub(crate) fn neighbourhood(stage: &Stage, near: &Near) -> Result<Answer, String> {
    let camera = near.of.from.camera(&stage.loaded.camera)?;
    let Pixel { row, column } = near.of.pixel.check(&camera)?;
    let view = View::new(&stage.loaded.scene, &camera);
    let radius = near.radius.min(MOST_RADIUS);
    let found = pixel::neighbourhood(&stage.rasterizer, &view, row, column, radius);
    let width = found.pixels.width;
    let samples = (0..).zip(&found.seen).map(|(place, id)| {
        let (row, column) = (found.pixels.row + place / width, found.pixels.column + place % width);
        json!({ "row": row, "column": column, "id": id })
    });
    let triangle = |Outline { id, corners }: &Outline| json!({ "id": id, "corners": corners });
    Ok(Answer::new(json!({
        "radius": radius,
        "samples": samples.collect::<Vec<Value>>(),
        "triangles": found.triangles.iter().map(triangle).collect::<Vec<Value>>(),
        "omitted": found.omitted,
    })))
}
