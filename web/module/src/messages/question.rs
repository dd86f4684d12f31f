//! `question`: the lecture's group problems with random numbers. `check`: whether an answer is right.
//!
//! The camera of the library computes what is right: no formula is written here a second time. The numbers are small
//! fractions, most of them with powers of two below, so that `f64` holds the answers exactly.

mod number;
mod text;

use super::outside::{of_rays, of_scene};
use crate::answer::Answer;
use crate::camera::CameraJson;
use bothways_lab::common::glam::Vec3;
use bothways_lab::common::{
    Camera, CameraDescription, Object, Options, Orientation, Plane, Scene, Shape, View,
};
use bothways_lab::raytrace;
use fastrand::Rng;
use number::Number;
use serde::{Deserialize, Serialize};
use serde_json::json;

/// Which question: its kind, and a number that chooses its numbers.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(crate) struct Which {
    kind: Kind,
    seed: u64,
}

/// The problems, in the lecture's order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    /// The viewing ray of a pixel of the canonical camera.
    Ray,
    /// Where that ray meets a plane.
    Plane,
    /// The eye is elsewhere.
    Eye,
    /// The viewport is not 1 × 1.
    Viewport,
    /// The viewport is not at distance 1.
    Distance,
    /// The camera is turned.
    Frame,
}

#[derive(Serialize)]
struct QuestionJson {
    title: &'static str,
    text: Vec<String>,
    fields: Vec<FieldJson>,
    hints: Vec<String>,
    camera: CameraJson,
    row: u32,
    column: u32,
}

#[derive(Serialize)]
struct FieldJson {
    name: &'static str,
    label: &'static str,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Check {
    kind: Kind,
    seed: u64,
    values: Vec<String>,
}

/// A question with its answer.
#[derive(Debug)]
pub(crate) struct Question {
    kind: Kind,
    camera: Camera,
    /// Row and column, counted from 0.
    pixel: [u32; 2],
    /// The plane to meet: `normal · p = constant`.
    plane: Option<([f32; 3], f32)>,
    /// What the picture shows.
    scene: Scene,
    fields: Vec<Field>,
}

/// A number to find.
#[derive(Debug)]
struct Field {
    name: &'static str,
    label: &'static str,
    right: f64,
}

const ORIGIN: [(&str, &str); 3] = [("px", "origin x"), ("py", "origin y"), ("pz", "origin z")];
const DIRECTION: [(&str, &str); 3] =
    [("dx", "direction x"), ("dy", "direction y"), ("dz", "direction z")];
const POINT: [(&str, &str); 3] = [("x", "point x"), ("y", "point y"), ("z", "point z")];

/// Frames `u`, `v`, `w` whose components are whole numbers or fifths.
const FRAMES: [[[f32; 3]; 3]; 6] = [
    [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
    [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]],
    [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
    [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
    [[0.8, 0.0, -0.6], [0.0, 1.0, 0.0], [0.6, 0.0, 0.8]],
    [[1.0, 0.0, 0.0], [0.0, 0.8, -0.6], [0.0, 0.6, 0.8]],
];

impl Question {
    fn new(which: Which) -> Result<Question, String> {
        let Which { kind, seed } = which;
        // Two kinds with one number are not to have the same numbers.
        let mut dice = Rng::with_seed(seed.wrapping_mul(8).wrapping_add(kind as u64));
        let mut description = CameraDescription {
            viewport: [1.0, 1.0],
            image: [pick(&mut dice, &[4, 8, 16]), pick(&mut dice, &[4, 8, 16])],
            ..CameraDescription::default()
        };
        let whole = |dice: &mut Rng| f32::from(dice.i8(-4..=4));
        if matches!(kind, Kind::Eye | Kind::Frame) {
            description.eye = loop {
                let eye = Vec3::new(whole(&mut dice), whole(&mut dice), whole(&mut dice));
                if eye != Vec3::ZERO {
                    break eye;
                }
            };
        }
        if matches!(kind, Kind::Viewport | Kind::Frame) {
            description.viewport =
                pick(&mut dice, &[[2.0, 1.5], [4.0, 3.0], [3.0, 2.0], [0.5, 2.0]]);
        }
        if matches!(kind, Kind::Distance | Kind::Frame) {
            description.distance = pick(&mut dice, &[2.0, 3.0, 0.5, 2.5, 4.0]);
        }
        if kind == Kind::Frame {
            let [u, v, w] = pick(&mut dice, &FRAMES).map(Vec3::from_array);
            description.orientation = Orientation::Frame { u, v, w };
        }
        let camera = Camera::new(description).map_err(|error| error.to_string())?;
        let [width, height] = description.image;
        let mut pixel = [dice.u32(..height), dice.u32(..width)];
        let plane = (kind == Kind::Plane).then(|| plane(&mut dice));
        if plane.is_some_and(|(normal, _)| normal == [0.0, 1.0, 0.0]) {
            // A floor is met below the middle.
            pixel[0] = dice.u32(height / 2..height);
        }
        let scene = scene(plane).map_err(|error| error.to_string())?;
        let mut question = Question { kind, camera, pixel, plane, scene, fields: Vec::new() };
        question.fields = question.right()?;
        Ok(question)
    }

    /// The numbers to find, from the library's camera and judge.
    fn right(&self) -> Result<Vec<Field>, String> {
        let [row, column] = self.pixel;
        let (ray, eye) = (self.camera.viewing_ray(row, column), self.camera.eye().as_dvec3());
        let fields = |names: [(&'static str, &'static str); 3], numbers: [f64; 3]| {
            let both = names.into_iter().zip(numbers);
            both.map(|((name, label), right)| Field { name, label, right: right + 0.0 })
        };
        if self.plane.is_none() {
            let origin = fields(ORIGIN, (eye + ray.origin).to_array());
            return Ok(origin.chain(fields(DIRECTION, ray.direction.to_array())).collect());
        }
        let view = View::new(&self.scene, &self.camera);
        let primitive = view.primitive(0);
        if !view.judge().covers(&primitive, &ray) {
            return Err("the ray of this question misses its plane, which is a bug".into());
        }
        let t = view.judge().distance(&primitive, &ray);
        let point = eye + ray.origin + t * ray.direction;
        let t = Field { name: "t", label: "t", right: t };
        Ok(std::iter::once(t).chain(fields(POINT, point.to_array())).collect())
    }

    /// The picture of the answer: the scene from outside.
    pub(crate) fn outside(&self) -> Answer {
        of_scene(&self.scene, &self.camera)
    }

    /// The picture of the answer: the ray.
    pub(crate) fn rays(&self) -> Result<Answer, String> {
        let view = View::new(&self.scene, &self.camera);
        of_rays(&view, &[self.pixel], || {
            raytrace::fast::render(&raytrace::fast::prepare(view.scene), &view, &Options::default())
        })
    }
}

fn pick<T: Copy>(dice: &mut Rng, from: &[T]) -> T {
    from[dice.usize(..from.len())]
}

/// A plane before the canonical camera, `normal · p = constant`, that every ray meets, or every one below the middle.
fn plane(dice: &mut Rng) -> ([f32; 3], f32) {
    let normal = pick(dice, &[[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 0.0, 2.0]]);
    (normal, -f32::from(dice.u8(1..=6)))
}

fn scene(plane: Option<([f32; 3], f32)>) -> Result<Scene, bothways_lab::common::SceneError> {
    let objects = plane.map(|(normal, constant)| {
        let normal = Vec3::from_array(normal);
        // A point on an axis that the plane crosses, where no coordinate is rounded.
        let axis = if normal.z == 2.0 {
            Vec3::X
        } else if normal.y == 1.0 {
            Vec3::Y
        } else {
            Vec3::Z
        };
        Object::from(Shape::Plane(Plane { point: constant * axis, normal }))
    });
    Scene::new(objects.into_iter().collect())
}

/// The question whose picture is asked for, if the arguments of a message name one.
pub(crate) fn of_picture(arguments: &str) -> Option<Result<Question, String>> {
    let which: Which = serde_json::from_str(arguments).ok()?;
    Some(Question::new(which))
}

pub(crate) fn question(which: &Which) -> Result<Answer, String> {
    let question = Question::new(*which)?;
    let field = |field: &Field| FieldJson { name: field.name, label: field.label };
    Ok(Answer::new(QuestionJson {
        title: question.title(),
        text: question.text(),
        fields: question.fields.iter().map(field).collect(),
        hints: question.hints(),
        camera: CameraJson::new(question.camera.description()),
        row: question.pixel[0],
        column: question.pixel[1],
    }))
}

pub(crate) fn check(check: &Check) -> Result<Answer, String> {
    let question = Question::new(Which { kind: check.kind, seed: check.seed })?;
    let fields = &question.fields;
    if check.values.len() != fields.len() {
        return Err(format!(
            "the answer has {} numbers; give {}",
            check.values.len(),
            fields.len()
        ));
    }
    let numbers = fields
        .iter()
        .zip(&check.values)
        .map(|(field, value)| value.parse().map_err(|error| format!("{}: {error}", field.label)));
    let numbers: Vec<Number> = numbers.collect::<Result<_, String>>()?;
    let pairs = fields.iter().zip(&numbers);
    let is_wrong = |(place, (field, number)): (usize, (&Field, &Number))| {
        (!number.is(field.right)).then_some(place)
    };
    let wrong: Vec<usize> = pairs.enumerate().filter_map(is_wrong).collect();
    let message = question.message(&numbers, &wrong);
    Ok(Answer::new(json!({ "right": wrong.is_empty(), "wrong": wrong, "message": message })))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    const KINDS: [Kind; 6] =
        [Kind::Ray, Kind::Plane, Kind::Eye, Kind::Viewport, Kind::Distance, Kind::Frame];

    fn checked(kind: Kind, seed: u64, values: Vec<String>) -> Value {
        check(&Check { kind, seed, values }).unwrap().json()
    }

    fn right(question: &Question) -> Vec<String> {
        question.fields.iter().map(|field| format!("{:.6}", field.right)).collect()
    }

    #[test]
    fn every_question_takes_the_right_answer_and_refuses_a_wrong_number_anywhere() {
        for kind in KINDS {
            for seed in 1..100 {
                let question = Question::new(Which { kind, seed }).unwrap();
                let values = right(&question);
                let answer = checked(kind, seed, values.clone());
                assert_eq!(answer["right"], true, "{kind:?} {seed}: {answer}");
                for place in 0..values.len() {
                    let mut values = values.clone();
                    values[place] = format!("{:.6}", question.fields[place].right + 0.125);
                    let answer = checked(kind, seed, values);
                    assert_eq!(answer["wrong"], json!([place]), "{kind:?} {seed}: {answer}");
                }
            }
        }
    }

    /// The lecture's formulas, written down once more.
    #[test]
    fn the_answers_are_those_of_the_lecture() {
        for kind in KINDS {
            for seed in 1..100 {
                let Question { camera, pixel: [row, column], plane, fields, .. } =
                    Question::new(Which { kind, seed }).unwrap();
                let ([vw, vh], [width, height]) =
                    (camera.viewport(), camera.image().map(f64::from));
                let [i, j] = [row + 1, column + 1].map(f64::from);
                let x = vw * ((j - 0.5) / width - 0.5);
                let y = -vh * ((i - 0.5) / height - 0.5);
                let direction = x * camera.u() + y * camera.v() - camera.distance() * camera.w();
                let eye = camera.eye().as_dvec3();
                let expected = match plane {
                    None => [eye.to_array(), direction.to_array()].concat(),
                    Some((normal, constant)) => {
                        let normal = Vec3::from_array(normal).as_dvec3();
                        let t = f64::from(constant) / normal.dot(direction);
                        assert!(t > 0.0, "{kind:?} {seed}");
                        let point = t * direction;
                        vec![t, point.x, point.y, point.z]
                    }
                };
                for (field, expected) in fields.iter().zip(expected) {
                    assert!((field.right - expected).abs() < 1e-12, "{kind:?} {seed} {field:?}");
                }
            }
        }
    }

    #[test]
    fn a_longer_direction_is_told_from_a_wrong_one() {
        let question = Question::new(Which { kind: Kind::Ray, seed: 3 }).unwrap();
        let doubled = question.fields.iter().map(|field| format!("{:.6}", 2.0 * field.right));
        let answer = checked(Kind::Ray, 3, doubled.collect());
        let says = answer["message"].as_str().unwrap();
        assert!(
            says.starts_with("This is the same ray, with a direction of another length"),
            "{says}"
        );
    }

    #[test]
    fn what_is_no_number_is_named() {
        let values = ["0", "0", "0", "a", "0", "-1"].map(str::to_owned).to_vec();
        let says = check(&Check { kind: Kind::Ray, seed: 1, values }).unwrap_err();
        assert_eq!(says, "direction x: \"a\" is not a number; write it as -3/8 or -0.375");
    }

    #[test]
    fn the_picture_shows_the_point() {
        let question = Question::new(Which { kind: Kind::Plane, seed: 5 }).unwrap();
        let rays = question.rays().unwrap();
        let json = rays.json();
        let point = &json["rays"][0]["point"];
        for (place, field) in question.fields[1..].iter().enumerate() {
            assert_eq!(point[place].as_f64().unwrap(), field.right);
        }
    }
}
