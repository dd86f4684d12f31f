//! Readers of the printed texts, which know nothing of our camera: each projects a point of the world as the documentation
//! of its system says.

use super::super::System;

type Vector = [f64; 3];
type Affine = [[f64; 4]; 3];

/// What a text says.
#[expect(clippy::large_enum_variant, reason = "there are few")]
pub(super) enum Reader {
    Clip {
        image: [u32; 2],
        view: [[f64; 4]; 4],
        projections: [[[f64; 4]; 4]; 2],
        y_down: bool,
    },
    Pbrt {
        image: [u32; 2],
        scale: Vector,
        look_at: [Vector; 3],
        fov: Option<f64>,
        window: [f64; 4],
    },
    Mitsuba {
        image: [u32; 2],
        to_world: Affine,
        fov: Option<f64>,
    },
    Blender {
        image: [u32; 2],
        world: Affine,
        lens: Option<[f64; 2]>,
        scale: f64,
        aspect: [f64; 2],
    },
    OpenCv {
        image: [u32; 2],
        k: [Vector; 3],
        r: [Vector; 3],
        t: Vector,
    },
    Colmap {
        image: [u32; 2],
        params: [f64; 4],
        turn: [f64; 4],
        t: Vector,
    },
}

impl Reader {
    pub(super) fn new(system: System, text: &str) -> Reader {
        match system {
            System::OpenGl => clip(text, "glViewport(0, 0, ", ", ", false),
            System::Vulkan => clip(text, "width = ", ", height = ", true),
            System::DirectX => clip(text, "Width = ", ", Height = ", false).of_rows(),
            System::Pbrt => pbrt(text),
            System::Mitsuba => mitsuba(text),
            System::Blender => blender(text),
            System::OpenCv => opencv(text),
            System::Colmap => colmap(text),
        }
    }

    pub(super) fn image(&self) -> [u32; 2] {
        match self {
            Reader::Clip { image, .. }
            | Reader::Pbrt { image, .. }
            | Reader::Mitsuba { image, .. }
            | Reader::Blender { image, .. }
            | Reader::OpenCv { image, .. }
            | Reader::Colmap { image, .. } => *image,
        }
    }

    /// Column and row of a point, from the upper left corner of the picture, pixel middles at ½.
    pub(super) fn pixel(&self, point: Vector) -> [f64; 2] {
        let [width, height] = self.image().map(f64::from);
        match self {
            // Vulkan 1.3, "Controlling the Viewport": x_f = (p_x / 2) x_d + o_x, downwards as clip space is. Direct3D 11.3,
            // 15.6: X = (X + 1) Width / 2, Y = (1 − Y) Height / 2. OpenGL 4.6, 13.8.1: as Vulkan, but upwards.
            Reader::Clip { projections: [projection, _], y_down, .. } => {
                let [x, y, _] = self.divided(projection, point);
                let down = if *y_down { y } else { -y };
                [(x + 1.0) / 2.0 * width, (down + 1.0) / 2.0 * height]
            }
            // pbrt-v4, `LookAt` in transform.cpp; `Perspective` and the screen window in cameras.h.
            Reader::Pbrt { scale, look_at: [eye, look, up], fov, window, .. } => {
                let forward = unit(minus(*look, *eye));
                let right = unit(cross(unit(*up), forward));
                let axes = [right, cross(forward, right), forward];
                let seen = axes.map(|axis| dot(axis, minus(point, *eye)));
                let [x, y, z] = [0, 1, 2].map(|axis| seen[axis] * scale[axis]);
                let unit_at = fov.map_or(1.0, |fov| z * (fov.to_radians() / 2.0).tan());
                let [left, right, bottom, top] = *window;
                [
                    (x / unit_at - left) / (right - left) * width,
                    (top - y / unit_at) / (top - bottom) * height,
                ]
            }
            // Mitsuba 3, sensor.h: `perspective_projection` and `orthographic_projection`, without crop and offset.
            Reader::Mitsuba { to_world, fov, .. } => {
                let [x, y, z] = inverse(to_world, point);
                let unit_at = fov.map_or(1.0, |fov| z * (fov.to_radians() / 2.0).tan());
                let sample_y = (1.0 - width / height * y / unit_at) / 2.0;
                [(1.0 - x / unit_at) / 2.0 * width, sample_y * height]
            }
            // Blender 4.5, `BKE_camera_params_compute_viewplane`, with CAMERA_SENSOR_FIT_HOR.
            Reader::Blender { world, lens, scale, aspect: [aspect_x, aspect_y], .. } => {
                let [x, y, z] = inverse(world, point);
                let seen = lens.map_or(*scale, |[lens, sensor]| sensor * -z / lens);
                let pixel = seen / width;
                let pixel_height = pixel * aspect_y / aspect_x;
                [width / 2.0 + x / pixel, height / 2.0 - y / pixel_height]
            }
            // OpenCV, calib3d: s p = K [R|t] P; a whole number is the middle of a pixel.
            Reader::OpenCv { k, r, t, .. } => {
                let seen = [0, 1, 2].map(|row| dot(r[row], point) + t[row]);
                let [x, y, s] = k.map(|row| dot(row, seen));
                [x / s + 0.5, y / s + 0.5]
            }
            // COLMAP, "Output Format" and `PinholeCameraModel`: the middle of the upper left pixel is (0.5, 0.5).
            Reader::Colmap { params: [fx, fy, cx, cy], turn: [w, x, y, z], t, .. } => {
                // q p q*, as p + 2 w (v × p) + 2 v × (v × p).
                let axis = [*x, *y, *z];
                let once = cross(axis, point);
                let twice = cross(axis, once);
                let [x, y, z] = [0, 1, 2].map(|i| point[i] + 2.0 * (w * once[i] + twice[i]) + t[i]);
                [fx * x / z + cx, fy * y / z + cy]
            }
        }
    }

    /// The depths of a point after the division by `w`: as the system has them by default, and reversed.
    pub(super) fn depths(&self, point: Vector) -> [f64; 2] {
        match self {
            Reader::Clip { projections, .. } => {
                [0, 1].map(|which| self.divided(&projections[which], point)[2])
            }
            _ => panic!("it has no depths"),
        }
    }

    fn divided(&self, projection: &[[f64; 4]; 4], [x, y, z]: Vector) -> Vector {
        let Reader::Clip { view, .. } = self else { panic!("it has no clip space") };
        let times = |matrix: &[[f64; 4]; 4], point: [f64; 4]| {
            matrix.map(|row| row.iter().zip(point).map(|(a, b)| a * b).sum::<f64>())
        };
        let [x, y, z, w] = times(projection, times(view, [x, y, z, 1.0]));
        [x / w, y / w, z / w]
    }

    /// The same matrices, written for points that are rows.
    fn of_rows(self) -> Reader {
        let turned = |matrix: [[f64; 4]; 4]| {
            [0, 1, 2, 3].map(|row| [0, 1, 2, 3].map(|column: usize| matrix[column][row]))
        };
        match self {
            Reader::Clip { image, view, projections, y_down } => {
                let projections = projections.map(turned);
                Reader::Clip { image, view: turned(view), projections, y_down }
            }
            other => other,
        }
    }
}

fn clip(text: &str, before_width: &str, before_height: &str, y_down: bool) -> Reader {
    let (width, rest) = whole(after(text, before_width));
    let (height, _) = whole(after(rest, before_height));
    let matrix = |heading: &str| {
        let lines = after(text, heading).lines().skip(1);
        let rows = lines.map(numbers_of).filter(|row| row.len() == 4).take(4);
        let rows: Vec<[f64; 4]> = rows.map(|row| row.try_into().unwrap()).collect();
        <[[f64; 4]; 4]>::try_from(rows).unwrap()
    };
    let projections = ["\nprojection: ", "\nthe same with reversed depth"].map(matrix);
    Reader::Clip { image: [width, height], view: matrix("\nview "), projections, y_down }
}

fn pbrt(text: &str) -> Reader {
    let code = text.lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>().join("\n");
    let parameter = |name: &str| {
        let (_, rest) = code.split_once(&format!("\"{name}\" ["))?;
        Some(numbers_of(rest.split(']').next().unwrap()))
    };
    let directive = |name: &str| {
        let words = after(&code, name).split_whitespace();
        words.map_while(|word| word.parse().ok()).collect::<Vec<f64>>()
    };
    let look_at: [f64; 9] = directive("LookAt ").try_into().unwrap();
    let [ex, ey, ez, lx, ly, lz, ux, uy, uz] = look_at;
    // A directive multiplies from the right: the scale stands first, and happens last.
    assert!(code.find("Scale") < code.find("LookAt") && code.find("LookAt") < code.find("Camera"));
    let fov = parameter("float fov").map(|fov| fov[0]);
    assert_eq!(fov.is_some(), code.contains("Camera \"perspective\""));
    assert_eq!(fov.is_none(), code.contains("Camera \"orthographic\""));
    Reader::Pbrt {
        image: ["integer xresolution", "integer yresolution"].map(|name| {
            let text = format!("{}", parameter(name).unwrap()[0]);
            text.parse().unwrap()
        }),
        scale: directive("Scale ").try_into().unwrap(),
        look_at: [[ex, ey, ez], [lx, ly, lz], [ux, uy, uz]],
        fov,
        window: parameter("float screenwindow").unwrap().try_into().unwrap(),
    }
}

fn mitsuba(text: &str) -> Reader {
    let value = |name: &str| {
        let (_, rest) = text.split_once(&format!("name=\"{name}\" value=\""))?;
        rest.split('"').next()
    };
    let matrix = after(text, "<matrix value=\"").split('"').next().unwrap();
    let fov = value("fov").map(|fov| fov.parse().unwrap());
    assert_eq!(fov.is_some(), text.contains("<sensor type=\"perspective\">"));
    assert_eq!(fov.is_none(), text.contains("<sensor type=\"orthographic\">"));
    assert_eq!(value("fov_axis"), fov.map(|_: f64| "x"));
    Reader::Mitsuba {
        image: ["width", "height"].map(|name| value(name).unwrap().parse().unwrap()),
        to_world: affine(&numbers_of(matrix)),
        fov,
    }
}

fn blender(text: &str) -> Reader {
    let value =
        |name: &str| Some(text.split_once(&format!(".{name} = "))?.1.lines().next().unwrap());
    let number = |name: &str| value(name).map(|word| word.parse::<f64>().unwrap());
    let resolution = |name: &str| value(name).unwrap().parse().unwrap();
    assert_eq!(value("sensor_fit"), Some("'HORIZONTAL'"));
    assert_eq!([number("shift_x"), number("shift_y")], [Some(0.0); 2]);
    let lens = number("lens").map(|lens| [lens, number("sensor_width").unwrap()]);
    assert_eq!(value("type"), Some(if lens.is_some() { "'PERSP'" } else { "'ORTHO'" }));
    let matrix = after(text, "Matrix((").split("))").next().unwrap();
    Reader::Blender {
        image: ["resolution_x", "resolution_y"].map(resolution),
        world: affine(&numbers_of(matrix)),
        lens,
        scale: number("ortho_scale").unwrap_or(f64::NAN),
        aspect: ["pixel_aspect_x", "pixel_aspect_y"].map(|name| number(name).unwrap()),
    }
}

fn opencv(text: &str) -> Reader {
    let array = |name: &str| {
        let words = after(text, &format!("\n{name} = np.array([")).split("])").next().unwrap();
        numbers_of(words)
    };
    let matrix = |name: &str| {
        let rows = array(name);
        assert_eq!(rows.len(), 9);
        [0, 3, 6].map(|row| [rows[row], rows[row + 1], rows[row + 2]])
    };
    let (width, rest) = whole(after(text, "image_size = ("));
    let (height, _) = whole(after(rest, ", "));
    let (k, r, t) = (matrix("K"), matrix("R"), array("t").try_into().unwrap());
    Reader::OpenCv { image: [width, height], k, r, t }
}

fn colmap(text: &str) -> Reader {
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let [camera, image, ""] = lines[..] else { panic!("{lines:?}") };
    let words: Vec<&str> = camera.split(' ').collect();
    let ["1", "PINHOLE", width, height, fx, fy, cx, cy] = words[..] else { panic!("{words:?}") };
    let pose = numbers_of(image.strip_suffix(" 1 object-order.png").unwrap());
    let [1.0, qw, qx, qy, qz, tx, ty, tz] = pose[..] else { panic!("{pose:?}") };
    Reader::Colmap {
        image: [width, height].map(|word| word.parse().unwrap()),
        params: [fx, fy, cx, cy].map(|word| word.parse().unwrap()),
        turn: [qw, qx, qy, qz],
        t: [tx, ty, tz],
    }
}

fn after<'a>(text: &'a str, what: &str) -> &'a str {
    text.split_once(what).unwrap_or_else(|| panic!("no {what:?} in:\n{text}")).1
}

/// A whole number at the beginning, and the rest.
fn whole(text: &str) -> (u32, &str) {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    (text[..end].parse().unwrap(), &text[end..])
}

/// All numbers of a text with other signs between them; none if there is a word that is no number.
fn numbers_of(text: &str) -> Vec<f64> {
    let words = text.split([' ', ',', '(', ')', '[', ']', '\n']).filter(|word| !word.is_empty());
    words.map(str::parse).collect::<Result<_, _>>().unwrap_or_default()
}

fn affine(numbers: &[f64]) -> Affine {
    assert_eq!((numbers.len(), &numbers[12..]), (16, &[0.0, 0.0, 0.0, 1.0][..]));
    [0, 4, 8].map(|row| [0, 1, 2, 3].map(|column| numbers[row + column]))
}

/// What the affine map takes to this point, by Cramer's rule.
fn inverse(map: &Affine, point: Vector) -> Vector {
    let [a, b, c, origin] = [0, 1, 2, 3].map(|column| map.map(|row| row[column]));
    let offset = minus(point, origin);
    let volume = dot(a, cross(b, c));
    [(b, c), (c, a), (a, b)].map(|(next, last)| dot(offset, cross(next, last)) / volume)
}

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Vector) -> Vector {
    a.map(|component| component / dot(a, a).sqrt())
}
