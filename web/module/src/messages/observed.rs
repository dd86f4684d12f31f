//! `observed`: the scene as an observer beside the camera sees it, for the view from outside: colours, and how far what is seen is,
//! so that the page knows which of its lines run behind it.
//!
//! Endless planes are left out: one between the observer and the camera would hide all, and the page draws a net in their place.

use crate::answer::{Answer, Buffer};
use crate::camera::Viewpoint;
use crate::observer::Observed;
use crate::stage::Stage;
use bothways_lab::common::{Frame, Options, View};
use bothways_lab::rasterize;
use serde::Deserialize;
use serde_json::json;

#[derive(Debug, Deserialize)]
pub(crate) struct Observe {
    /// The observer, as a camera.
    #[serde(flatten)]
    from: Viewpoint,
}

pub(crate) fn answer(stage: &mut Stage, observe: &Observe) -> Result<Answer, String> {
    let camera = observe.from.camera(&stage.loaded.camera)?;
    let Stage { loaded, rasterizer, observed, .. } = stage;
    let observed = match observed {
        Some(observed) => observed,
        None => observed
            .insert(Observed::new(&loaded.scene, &camera).map_err(|error| error.to_string())?),
    };
    let (scene, prepared) = match &observed.bounded {
        Some((scene, prepared)) => (scene, prepared),
        None => (&loaded.scene, &*rasterizer),
    };
    let (view, frame) = (View::new(scene, &camera), &mut observed.frame);
    rasterize::fast::determine_visibility(prepared, &view, &Options::default(), frame, &mut ());
    rasterize::shade(&view, frame);
    let [width, height] = camera.image();
    Ok(Answer::new(json!({ "width": width, "height": height }))
        .with("rgba", Buffer::U8(cut_out(frame)))
        .with("t", Buffer::F32(frame.distances().to_vec())))
}

/// The picture with four bytes for each pixel, transparent where nothing is seen: the page has its own ground.
fn cut_out(frame: &Frame) -> Vec<u8> {
    let pixels = frame.picture().iter().zip(frame.ids().iter());
    let bytes = pixels.flat_map(|(&[red, green, blue], id)| match id {
        Some(_) => [red, green, blue, u8::MAX],
        None => [0; 4],
    });
    bytes.collect()
}

#[cfg(test)]
mod tests {
    use crate::Engine;
    use crate::answer::{Answer, Buffer};
    use serde_json::json;

    fn observed(scene: &str, arguments: &str) -> Result<Answer, String> {
        let mut engine = Engine::default();
        engine.call("open", &format!(r#"{{"name": "{scene}"}}"#), None).unwrap();
        engine.call("observed", arguments, None)
    }

    /// A parallel observer above the ground, who looks down on 8 × 6 units of it from a height of 5.
    const ABOVE: &str = r#"{"camera": {"projection": "parallel", "eye": [0, 5, 0], "u": [1, 0, 0], "v": [0, 0, -1],
        "w": [0, 1, 0], "d": 8, "vw": 8, "vh": 6, "width": 80, "height": 60}}"#;

    fn buffers(answer: &Answer) -> (&[u8], &[f32]) {
        match (answer.buffer("rgba"), answer.buffer("t")) {
            (Some(Buffer::U8(rgba)), Some(Buffer::F32(t))) => (rgba, t),
            others => panic!("{others:?}"),
        }
    }

    #[test]
    fn an_observer_sees_the_scene_without_its_planes_and_how_far_it_is() {
        let answer = observed("lecture", ABOVE).unwrap();
        let (rgba, t) = buffers(&answer);
        assert_eq!((rgba.len(), t.len()), (4 * 80 * 60, 80 * 60));
        // The ball at (1.25, 0.42, 1.0), of radius 0.42: about its middle, x goes to the right and z down.
        let ball = 60 * 40 / 60 * 80 + 52;
        assert!((t[ball] - 4.16).abs() < 0.01, "{}", t[ball]);
        assert_eq!(rgba[4 * ball + 3], 255);
        // In a corner there is the floor alone, which is left out.
        assert_eq!((&rgba[..4], t[0]), (&[0; 4][..], f32::INFINITY));
    }

    #[test]
    fn what_is_seen_is_what_image_order_sees() {
        let mut engine = Engine::default();
        engine.call("open", r#"{"name": "ties"}"#, None).unwrap();
        let observed = engine.call("observed", ABOVE, None).unwrap();
        let both = engine.call("render", ABOVE, None).unwrap();
        let (Some(Buffer::U8(picture)), Some(Buffer::U32(ids))) =
            (both.buffer("image.rgba"), both.buffer("image.ids"))
        else {
            panic!("{both:?}");
        };
        let (rgba, _) = buffers(&observed);
        assert!(ids.iter().any(|&id| id != u32::MAX), "something is seen");
        for (pixel, id) in ids.iter().enumerate() {
            let expected =
                if *id == u32::MAX { &[0; 4] } else { &picture[4 * pixel..4 * pixel + 4] };
            assert_eq!(&rgba[4 * pixel..4 * pixel + 4], expected, "pixel {pixel}");
        }
    }

    #[test]
    fn another_scene_has_another_picture_and_a_scene_of_planes_has_none() {
        let mut engine = Engine::default();
        let mut seen = |open: &str, bytes: Option<&[u8]>| {
            engine.call("open", open, bytes).unwrap();
            let answer = engine.call("observed", ABOVE, None).unwrap();
            buffers(&answer).0.chunks(4).filter(|pixel| pixel[3] > 0).count()
        };
        assert!(seen(r#"{"name": "lecture"}"#, None) > 0);
        let planes = "[camera]\n[[object]]\nplane = { point = [0, 0, 0], normal = [0, 1, 0] }\n";
        let file = json!({ "name": "planes.toml", "bytes": planes.len() });
        let open = json!({ "name": "planes.toml", "files": [file] }).to_string();
        assert_eq!(seen(&open, Some(planes.as_bytes())), 0);
        assert!(seen(r#"{"name": "ties"}"#, None) > 0);
    }

    #[test]
    fn bad_values_are_refused_with_reasons() {
        let says = |from: &str, to: &str| {
            assert!(ABOVE.contains(from));
            observed("ties", &ABOVE.replace(from, to)).unwrap_err()
        };
        assert!(says(r#""width": 80"#, r#""width": 8000000"#).contains("too large for a browser"));
        assert!(says(r#""width": 80"#, r#""width": 0"#).contains("image"));
        assert!(says(r#""vw": 8"#, r#""vw": -8"#).contains("viewport"));
        assert!(says("[0, 1, 0]", "[0, 0, 0]").contains("zero"));
        assert!(says(r#""eye": [0, 5, 0]"#, r#""eye": [0, 5]"#).contains("wrong arguments"));
        let none = Engine::default().call("observed", ABOVE, None).unwrap_err();
        assert_eq!(none, "no scene is open; open one first");
    }
}
