//! The words of a question: its text, its hints step by step, and what is said to an answer.

use super::number::Number;
use super::{Kind, Question};
use bothways_lab::common::glam::DVec3;

impl Question {
    pub(super) fn title(&self) -> &'static str {
        match self.kind {
            Kind::Ray => "Generate a viewing ray",
            Kind::Plane => "Intersect the ray with a plane",
            Kind::Eye => "The eye is not at the origin",
            Kind::Viewport => "vh \u{2260} vw \u{2260} 1",
            Kind::Distance => "d \u{2260} 1",
            Kind::Frame => "Point the camera somewhere else",
        }
    }

    pub(super) fn text(&self) -> Vec<String> {
        let ([row, column], [width, height]) = (self.pixel, self.camera.image());
        let camera = self.camera_words();
        let pixel = format!(
            "The image has H = {height} rows and W = {width} columns. Take the pixel in row {row} and column {column}, \
             counted from 0: in the lecture's formulas i = {} and j = {}.",
            row + 1,
            column + 1
        );
        let asked = match self.plane {
            None => "What is its viewing ray r(t) = p + t d?".into(),
            Some(plane) => format!(
                "At which t does its viewing ray meet the plane {}, and in which point?",
                equation(plane)
            ),
        };
        vec![camera, pixel, asked]
    }

    /// The camera, as far as it is not the canonical one.
    fn camera_words(&self) -> String {
        let camera = &self.camera;
        let ([vw, vh], d) = (camera.viewport(), camera.distance());
        let eye = vector(camera.eye().as_dvec3());
        let (vw, vh, d) = (number(vw), number(vh), number(d));
        match self.kind {
            Kind::Ray | Kind::Plane => {
                "The camera is the canonical one: the eye at the origin, looking down the negative z axis, vw = vh = d = 1."
                    .into()
            }
            Kind::Eye => format!(
                "The eye is at {eye}. All else is as for the canonical camera: it looks down the negative z axis, \
                 vw = vh = d = 1."
            ),
            Kind::Viewport => format!(
                "The viewport is vw = {vw} wide and vh = {vh} high. All else is as for the canonical camera: the eye at \
                 the origin, looking down the negative z axis, d = 1."
            ),
            Kind::Distance => format!(
                "The viewport is at distance d = {d} from the eye. All else is as for the canonical camera: the eye at the \
                 origin, looking down the negative z axis, vw = vh = 1."
            ),
            Kind::Frame => {
                let [u, v, w] = [camera.u(), camera.v(), camera.w()].map(vector);
                format!(
                    "The eye is at {eye}. The camera's frame is u = {u}, v = {v}, w = {w}; vw = {vw}, vh = {vh}, d = {d}."
                )
            }
        }
    }

    pub(super) fn hints(&self) -> Vec<String> {
        let camera = &self.camera;
        let ([row, column], [width, height]) = (self.pixel, camera.image());
        let ([vw, vh], d) = (camera.viewport(), camera.distance());
        let raster = camera.raster(1);
        let coordinate =
            |mut all: Box<dyn Iterator<Item = f64>>, index: u32| all.nth(index as usize);
        let x = coordinate(Box::new(raster.x()), column).unwrap_or_default();
        let y = coordinate(Box::new(raster.y()), row).unwrap_or_default();
        let (i, j) = (row + 1, column + 1);
        let mut hints = vec![
            "First find where the middle of the pixel lies on the viewport: x to the right, y up, both counted from the \
             viewport's middle."
                .to_owned(),
            "x = vw ((j \u{2212} 1/2)/W \u{2212} 1/2) and y = \u{2212}vh ((i \u{2212} 1/2)/H \u{2212} 1/2).".to_owned(),
            format!(
                "x = {} (({j} \u{2212} 1/2)/{width} \u{2212} 1/2) = {}, and y = \u{2212}{} (({i} \u{2212} 1/2)/{height} \
                 \u{2212} 1/2) = {}.",
                number(vw),
                number(x),
                number(vh),
                number(y)
            ),
        ];
        hints.push(match self.kind {
            Kind::Frame => "The origin is the eye. The direction is x u + y v \u{2212} d w: x steps to the right, y up, \
                            and d forwards, which is against w."
                .into(),
            Kind::Eye => "The ray begins at the eye. Its direction is (x, y, \u{2212}d): moving the eye moves the viewport \
                          along, so the direction does not change."
                .into(),
            _ => format!(
                "The ray begins at the eye, (0, 0, 0). Its direction is (x, y, \u{2212}d), with d = {}.",
                number(d)
            ),
        });
        if let Some(plane) = self.plane {
            let direction = camera.viewing_ray(row, column).direction;
            hints.push(format!("So d = {}.", vector(direction)));
            hints.push(format!(
                "A point of the ray is t d, as it begins at the origin. Put its coordinates into {}, and solve for t.",
                equation(plane)
            ));
            hints.push("The point is t d, with the t that you found.".into());
        }
        hints
    }

    /// What is said to an answer; nothing special is the empty text.
    pub(super) fn message(&self, numbers: &[Number], wrong: &[usize]) -> String {
        if wrong.is_empty() {
            return match self.plane {
                None => "Right: that is the viewing ray.".into(),
                Some(_) => "Right: that is where the ray meets the plane.".into(),
            };
        }
        if self.plane.is_none() && wrong.iter().all(|&place| place >= 3) {
            let given = of(numbers.iter().map(|number| number.value));
            let right = of(self.fields.iter().map(|field| field.right));
            let scale = given.dot(right) / right.length_squared();
            if scale > 0.0 && (given - scale * right).length() < 1e-3 * given.length() {
                return "This is the same ray, with a direction of another length. The lecture's direction reaches from \
                        the eye just to the viewport; t counts in its lengths, so give that one."
                    .into();
            }
            if scale < 0.0 && (given - scale * right).length() < 1e-3 * given.length() {
                return "This ray goes the other way, to what lies behind the eye.".into();
            }
        }
        let labels: Vec<&str> = wrong.iter().map(|&place| self.fields[place].label).collect();
        format!("Not yet: look again at {}.", labels.join(", "))
    }
}

/// The last three of some numbers.
fn of(numbers: impl Iterator<Item = f64>) -> DVec3 {
    let numbers: Vec<f64> = numbers.collect();
    DVec3::from_slice(&numbers[numbers.len() - 3..])
}

/// `y + z = -4`
fn equation((normal, constant): ([f32; 3], f32)) -> String {
    let terms = normal.into_iter().zip(["x", "y", "z"]).filter(|(factor, _)| *factor != 0.0);
    let term = |(factor, name): (f32, &str)| match factor {
        1.0 => name.to_owned(),
        _ => format!("{} {name}", number(f64::from(factor))),
    };
    let sum = terms.map(term).collect::<Vec<_>>().join(" + ");
    format!("{sum} = {}", number(f64::from(constant)))
}

fn vector(vector: DVec3) -> String {
    let [x, y, z] = vector.to_array().map(number);
    format!("({x}, {y}, {z})")
}

/// A number as a fraction with a small number below, if it is one; with a minus sign as it is printed.
fn number(value: f64) -> String {
    const LARGEST: u32 = 64;
    // The camera stores 0.8 as f32, and makes its frame of it.
    const NEAR: f64 = 1e-6;
    let sign = if value < -NEAR { "\u{2212}" } else { "" };
    let value = value.abs();
    for below in 1..=LARGEST {
        let above = (value * f64::from(below)).round();
        if (value - above / f64::from(below)).abs() < NEAR {
            return match below {
                1 => format!("{sign}{above}"),
                _ => format!("{sign}{above}/{below}"),
            };
        }
    }
    format!("{sign}{value}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_fractions() {
        let written = [0.0, -0.0, 3.0, -0.375, 0.800_000_01, 1.0 / 3.0, -1.5].map(number);
        let minus = "\u{2212}";
        let expected = ["0", "0", "3", "-3/8", "4/5", "1/3", "-3/2"];
        assert_eq!(written, expected.map(|text| text.replace('-', minus)));
        assert_eq!(equation(([1.0, 0.0, 2.0], -4.0)), format!("x + 2 z = {minus}4"));
    }
}
