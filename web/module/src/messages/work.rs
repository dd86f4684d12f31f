//! `work`: what both orders count for a sphere of some triangles in an image of some pixels, as a sweep counts it.

use crate::answer::Answer;
use crate::clock::timed;
use bothways_lab::common::{Camera, Frame, Object, Options, Scene, View, Work};
use bothways_lab::sweep::{Axis, Case, steps};
use bothways_lab::{rasterize, raytrace};
use serde::Deserialize;
use serde_json::json;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Measure {
    triangles: u32,
    height: u32,
    width: u32,
}

/// The most triangles and pixels: more take a browser too long.
const MOST_TRIANGLES: u32 = 1_000_000;
const MOST_PIXELS: u64 = 1 << 21;

pub(crate) fn answer(measure: &Measure) -> Result<Answer, String> {
    let Measure { triangles, height, width } = *measure;
    let pixels = u64::from(width) * u64::from(height);
    if triangles > MOST_TRIANGLES || pixels > MOST_PIXELS {
        return Err(format!(
            "at most {MOST_TRIANGLES} triangles and {MOST_PIXELS} pixels are measured here; choose fewer"
        ));
    }
    let (shape, camera) = sphere(triangles, [width, height]).shape();
    let camera = Camera::new(camera).map_err(|error| error.to_string())?;
    let scene = Scene::new(vec![Object::from(shape)]);
    let scene = scene.map_err(|error| error.to_string())?;
    let view = View::new(&scene, &camera);

    let options = Options::default();
    let mut frame = Frame::new(&camera, &options);
    let (rasterizer, prepare_object) = timed(|| rasterize::fast::prepare(&scene));
    let (ray_tracer, prepare_image) = timed(|| raytrace::fast::prepare(&scene));
    let mut work = [Work::default(); 2];
    rasterize::fast::determine_visibility(&rasterizer, &view, &options, &mut frame, &mut work[0]);
    raytrace::fast::determine_visibility(&ray_tracer, &view, &options, &mut frame, &mut work[1]);
    let (_, object) = timed(|| {
        rasterize::fast::determine_visibility(&rasterizer, &view, &options, &mut frame, &mut ())
    });
    let (_, image) = timed(|| {
        raytrace::fast::determine_visibility(&ray_tracer, &view, &options, &mut frame, &mut ())
    });
    let [by_object, by_image] = work;
    let row = |label: &str, object: Option<u64>, image: Option<u64>| json!({ "label": label, "object": object, "image": image });
    let triangles = scene.primitive_count();
    Ok(Answer::new(json!({
        "triangles": triangles,
        "counts": [
            row("objects begun", Some(by_object.primitives), None),
            row("rays begun", None, Some(by_image.rays)),
            row("box tests", None, Some(by_image.nodes)),
            row("tests of a pair", Some(by_object.tests), Some(by_image.tests)),
            row("fragments", Some(by_object.fragments), Some(by_image.fragments)),
            row("depth comparisons", Some(by_object.depth_tests), Some(by_image.depth_tests)),
        ],
        "steps": { "object": steps(&by_object), "image": steps(&by_image) },
        "textbook": triangles * pixels,
        "ms": { "object": object, "image": image },
        "prepare_ms": { "object": prepare_object, "image": prepare_image },
    })))
}

/// The smallest sphere of a sweep with at least so many triangles.
fn sphere(triangles: u32, image: [u32; 2]) -> Case {
    let has_enough = |rings: &u32| 4 * rings * rings >= triangles;
    let rings = (2..=MOST_TRIANGLES).find(has_enough).unwrap_or(MOST_TRIANGLES);
    Case::sphere(Axis::Triangles, rings, image)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_have_about_the_triangles_that_are_asked_for() {
        for triangles in [12, 100, 5000, 200_000] {
            let (shape, _) = sphere(triangles, [40, 30]).shape();
            let found = shape.primitive_count();
            let ratio = found as f64 / f64::from(triangles);
            assert!((1.0..1.4).contains(&ratio), "{triangles}: {found}");
        }
    }
}
