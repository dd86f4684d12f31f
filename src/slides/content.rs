//! What is on each slide, in the order of the lecture, and how it is drawn.

use super::stills;
use crate::common::{Camera, Projection, View};
use crate::figure::{Drawing, Kind, Subject, Theme, sweep_chart};
use crate::film::{Film, Length, default_size};
use crate::orders::{Method, Order, Rules};
use crate::scenes::{self, LoadedScene};
use crate::sweep::{self, Axis, Bench, Quantity, Summary, Table};
use thiserror::Error;

/// A slide that is drawn.
#[derive(Debug)]
pub enum Content {
    /// A drawing, as SVG.
    Drawing(Box<Drawing>),
    /// A film, as GIF.
    Film(Vec<u8>),
}

/// Why a slide cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct SlideError(pub(crate) String);

/// A slide of the plan.
#[derive(Debug)]
pub(super) struct Planned<'a> {
    /// The name of its file, without number and ending.
    pub(super) name: String,
    pub(super) title: String,
    pub(super) caption: &'static str,
    pub(super) notes: &'static str,
    pub(super) plan: Plan<'a>,
}

/// What a slide shows.
#[derive(Debug)]
pub(super) struct Plan<'a> {
    scene: Shown<'a>,
    what: What,
    /// Another projection than the scene's own.
    projection: Option<Projection>,
    rules: Rules,
    pixels: Vec<[u32; 2]>,
}

/// The scene of a slide: one of the user's, or one of the built-in ones.
#[derive(Debug)]
enum Shown<'a> {
    Given(&'a LoadedScene),
    BuiltIn(Box<LoadedScene>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum What {
    Figure(Kind),
    Stills(Order),
    Film(Method),
    Sweep(Axis),
}

/// The image and the most triangles of the cost curves: they take seconds.
const SWEEP_IMAGE: [u32; 2] = [320, 180];
const MOST_TRIANGLES: u64 = 100_000;

/// The width of a film on a slide.
const FILM_WIDTH: u32 = 960;

impl Plan<'_> {
    pub(super) fn ending(&self) -> &'static str {
        match self.what {
            What::Figure(_) | What::Stills(_) | What::Sweep(_) => "svg",
            What::Film(_) => "gif",
        }
    }

    pub(super) fn draw(&self, theme: Theme) -> Result<Content, SlideError> {
        let loaded = match &self.scene {
            Shown::Given(loaded) => loaded,
            Shown::BuiltIn(loaded) => &**loaded,
        };
        let wrong = |error: &dyn std::fmt::Display| SlideError(format!("{}: {error}", loaded.name));
        let mut description = loaded.camera;
        if let Some(projection) = self.projection {
            description = scenes::with_projection(&description, projection, &loaded.scene)
                .map_err(|error| wrong(&error))?;
        }
        if let What::Film(method) = self.what {
            description.image = default_size(description.image, method);
        }
        let camera = Camera::new(description).map_err(|error| wrong(&error))?;
        let view = View::new(&loaded.scene, &camera);
        let subject = Subject {
            name: &loaded.name,
            about: loaded.about(),
            view,
            pixels: &self.pixels,
            samples: 1,
            rules: self.rules,
            theme,
        };
        match self.what {
            What::Figure(kind) => kind
                .draw(&subject)
                .map(Box::new)
                .map(Content::Drawing)
                .map_err(|error| wrong(&error)),
            What::Stills(order) => {
                stills::draw(&subject, order).map(Box::new).map(Content::Drawing)
            }
            What::Film(method) => film(&subject, method).map_err(|error| wrong(&error)),
            What::Sweep(axis) => sweep(axis, theme),
        }
    }
}

fn film(subject: &Subject, method: Method) -> Result<Content, Box<dyn std::error::Error>> {
    let length = Length::new(8.0, 25, 2.0)?;
    let film = Film::record(subject.name, &subject.view, method, length)?;
    Ok(Content::Film(film.write_gif(Vec::new(), subject.theme, FILM_WIDTH, &mut |_| {})?))
}

/// A cost curve: steps, which are the same on every machine.
fn sweep(axis: Axis, theme: Theme) -> Result<Content, SlideError> {
    let plan = sweep::Plan {
        image: SWEEP_IMAGE,
        most: MOST_TRIANGLES,
        times: false,
        ..sweep::Plan::default()
    };
    let (mut bench, mut table) = (Bench::default(), Table::default());
    for task in plan.tasks(&[axis]) {
        table.insert(task, bench.measure(&task));
    }
    let summary = Summary::of(&table, axis, Quantity::Steps)
        .ok_or_else(|| SlideError(format!("a sweep of {} has no points", axis.name())))?;
    let drawing = sweep_chart(&summary, "counted, so the same on every machine", plan.image, theme);
    Ok(Content::Drawing(Box::new(drawing)))
}

impl<'a> Planned<'a> {
    fn new(
        name: &str,
        title: &str,
        [caption, notes]: [&'static str; 2],
        scene: Shown<'a>,
        what: What,
    ) -> Planned<'a> {
        let plan =
            Plan { scene, what, projection: None, rules: Rules::default(), pixels: Vec::new() };
        Planned { name: name.into(), title: title.into(), caption, notes, plan }
    }

    fn projected(mut self, projection: Projection) -> Planned<'a> {
        self.plan.projection = Some(projection);
        self
    }

    fn ruled(mut self, object_order: &str) -> Result<Planned<'a>, SlideError> {
        let rule =
            object_order.parse().map_err(|error| SlideError(format!("{object_order}: {error}")))?;
        self.plan.rules.object_order = Some(rule);
        Ok(self)
    }
}

/// All slides.
pub(super) fn plans(given: &[LoadedScene], films: bool) -> Result<Vec<Planned<'_>>, SlideError> {
    let Some((first, others)) = given.split_first() else { return Ok(Vec::new()) };
    let mut plans = lecture(first, films)?;
    for scene in others {
        plans.extend(chapter(scene, films));
    }
    Ok(plans)
}

fn built_in<'a>(name: &str) -> Result<Shown<'a>, SlideError> {
    let loaded = scenes::load(name).map_err(|error| SlideError(error.to_string()))?;
    Ok(Shown::BuiltIn(Box::new(loaded)))
}

/// The lecture with its first scene.
fn lecture(first: &LoadedScene, films: bool) -> Result<Vec<Planned<'_>>, SlideError> {
    let given = || Shown::Given(first);
    let figure = What::Figure;
    let mut plans = vec![
        Planned::new("image", "What is an image?", WORDS.image, given(), figure(Kind::Image)),
        Planned::new(
            "object-order",
            "Object order",
            WORDS.object_order,
            given(),
            What::Stills(Order::Object),
        ),
        Planned::new(
            "image-order",
            "Image order",
            WORDS.image_order,
            given(),
            What::Stills(Order::Image),
        ),
        Planned::new(
            "camera-perspective",
            "The camera: perspective",
            WORDS.perspective,
            given(),
            figure(Kind::Camera),
        )
        .projected(Projection::Perspective),
        Planned::new(
            "camera-parallel",
            "The camera: parallel",
            WORDS.parallel,
            given(),
            figure(Kind::Camera),
        )
        .projected(Projection::Parallel),
        Planned::new(
            "edge-functions",
            "Coverage: three half-planes",
            WORDS.edges,
            given(),
            figure(Kind::EdgeFunctions),
        ),
        Planned::new("grid", "Coverage: samples", WORDS.grid, given(), figure(Kind::Grid)),
        Planned::new("ties", "The tie rule", WORDS.ties, built_in("ties")?, figure(Kind::Grid)),
        Planned::new("ray", "The nearest along a ray", WORDS.ray, given(), figure(Kind::Ray)),
        Planned::new(
            "depth-complexity",
            "Depth complexity",
            WORDS.depth,
            given(),
            figure(Kind::DepthComplexity),
        ),
        Planned::new("work", "Work", WORDS.work, given(), figure(Kind::Work)),
        Planned::new(
            "hierarchy",
            "Skipping work",
            WORDS.hierarchy,
            given(),
            figure(Kind::Hierarchy),
        ),
        Planned::new(
            "order",
            "When is a pixel decided?",
            WORDS.order,
            given(),
            figure(Kind::Order),
        ),
        Planned::new(
            "cost-triangles",
            "Cost: more triangles",
            WORDS.triangles,
            given(),
            What::Sweep(Axis::Triangles),
        ),
        Planned::new(
            "cost-pixels",
            "Cost: more pixels",
            WORDS.pixels,
            given(),
            What::Sweep(Axis::Pixels),
        ),
        Planned::new("agree", "Both orders agree", WORDS.agree, given(), figure(Kind::SideBySide)),
        Planned::new(
            "reasons",
            "When real systems do not agree",
            WORDS.reasons,
            built_in("ties")?,
            figure(Kind::Reasons),
        )
        .ruled("inclusive")?,
        Planned::new(
            "zoom",
            "What it looks like",
            WORDS.zoom,
            built_in("ties")?,
            figure(Kind::Zoom),
        )
        .ruled("inclusive")?,
    ];
    if films {
        plans.push(Planned::new(
            "film-textbook",
            "Film: the textbook's loops",
            WORDS.film,
            given(),
            What::Film(Method::Textbook),
        ));
        plans.push(Planned::new(
            "film-fast",
            "Film: the fast renderers",
            WORDS.fast_film,
            given(),
            What::Film(Method::Fast),
        ));
    }
    // A scene of planes and spheres has no edges, and one of planes alone no boxes: those slides would be empty.
    plans.retain(|planned| planned.plan.applies());
    Ok(plans)
}

/// What differs from scene to scene.
fn chapter(scene: &LoadedScene, films: bool) -> Vec<Planned<'_>> {
    let kinds = [
        (Kind::SideBySide, "both orders", WORDS.agree),
        (Kind::Camera, "the camera", WORDS.camera),
        (Kind::DepthComplexity, "depth complexity", WORDS.depth),
        (Kind::Work, "work", WORDS.work),
        (Kind::Hierarchy, "skipping work", WORDS.hierarchy),
        (Kind::Order, "when is a pixel decided?", WORDS.order),
    ];
    let name = |what: &str| format!("{}-{what}", scene.name);
    let title = |what: &str| format!("{}: {what}", scene.name);
    let mut plans: Vec<Planned> = kinds
        .into_iter()
        .map(|(kind, what, words)| {
            Planned::new(
                &name(kind.name()),
                &title(what),
                words,
                Shown::Given(scene),
                What::Figure(kind),
            )
        })
        .collect();
    if films {
        let what = What::Film(Method::Fast);
        plans.push(Planned::new(
            &name("film"),
            &title("film"),
            WORDS.fast_film,
            Shown::Given(scene),
            what,
        ));
    }
    plans.retain(|planned| planned.plan.applies());
    plans
}

impl Plan<'_> {
    /// Whether the scene has what the slide is about.
    fn applies(&self) -> bool {
        use crate::common::Shape;
        let loaded = match &self.scene {
            Shown::Given(loaded) => loaded,
            Shown::BuiltIn(loaded) => &**loaded,
        };
        let mut shapes = loaded.scene.objects().iter().map(|object| &object.shape);
        match self.what {
            What::Figure(Kind::EdgeFunctions) => {
                shapes.any(|shape| matches!(shape, Shape::Triangle(_) | Shape::Mesh(_)))
            }
            What::Figure(Kind::Hierarchy) => shapes.any(|shape| !matches!(shape, Shape::Plane(_))),
            // The textbook of a large scene takes too long; its still would be of a handful of pixels.
            What::Stills(_) | What::Film(Method::Textbook) => {
                loaded.scene.primitive_count() <= 60_000
            }
            What::Figure(_) | What::Film(Method::Fast) | What::Sweep(_) => true,
        }
    }
}

/// Captions and notes.
struct Words {
    image: [&'static str; 2],
    object_order: [&'static str; 2],
    image_order: [&'static str; 2],
    perspective: [&'static str; 2],
    camera: [&'static str; 2],
    parallel: [&'static str; 2],
    edges: [&'static str; 2],
    grid: [&'static str; 2],
    ties: [&'static str; 2],
    ray: [&'static str; 2],
    depth: [&'static str; 2],
    work: [&'static str; 2],
    hierarchy: [&'static str; 2],
    order: [&'static str; 2],
    triangles: [&'static str; 2],
    pixels: [&'static str; 2],
    agree: [&'static str; 2],
    reasons: [&'static str; 2],
    zoom: [&'static str; 2],
    film: [&'static str; 2],
    fast_film: [&'static str; 2],
}

const WORDS: Words = Words {
    image: [
        "An image is rows and columns of pixels; to draw is to decide the colour of each.",
        "Begin with the smallest thing there is: canvas[i, j] = color. Ask which pixels of the patch belong to the object, \
         and how one would know. Everything after this answers that question, in two orders.",
    ],
    object_order: [
        "The outer loop goes through the scene: for each object, for each pixel.",
        "Read the loops aloud. Let the class say which pixels change next. A pixel can be painted again by a nearer object: \
         so the program must remember how near the stored one is. That memory is the z-buffer.",
    ],
    image_order: [
        "The outer loop goes through the picture: for each pixel, for each object.",
        "The same two loops, swapped. Here one variable is enough to remember the nearest object, because a pixel is finished \
         before the next one begins. Ask which order needs the whole scene in memory, and which the whole picture.",
    ],
    perspective: [
        "Perspective: all viewing rays start at the eye.",
        "Derive the ray on the board before showing the numbers. Half a pixel: the ray goes through the middle of its pixel. \
         The minus in y: rows count down, v points up. Everything on one ray falls on one pixel: so a D is lost.",
    ],
    parallel: [
        "Parallel: all viewing rays have the same direction.",
        "Compare with the slide before: origin and direction have swapped roles. Lengths do not shrink with distance, so \
         engineers measure in such drawings.",
    ],
    camera: [
        "The camera of this scene, and what some of its rays hit.",
        "Ask which projection it is before reading the title: do the rays meet in a point, or have they one direction?",
    ],
    edges: [
        "A triangle is the intersection of three half-planes.",
        "One edge function answers on which side of one edge a sample lies. Three answers make 'if inside triangle'. On the \
         raster each is affine: one addition leads from a pixel to the next, which is why rasterizers like them.",
    ],
    grid: [
        "Only samples are asked: a pixel is covered if its middle is.",
        "Pick a pixel that the triangle touches without covering. Nothing between samples is ever asked. Count signs in one \
         cell together. Samples a pixel more would see more; they never see all.",
    ],
    ties: [
        "A sample exactly on an edge belongs to exactly one side.",
        "Why a rule at all? Two triangles share an edge: without a rule its samples are drawn twice, or never. Moving the sample \
         a little decides every tie in the same way, for both orders, without any epsilon.",
    ],
    ray: [
        "Of all crossings with t > 0 the nearest is seen.",
        "r(t) = p + t d. The ray need not test everything: a box that it misses spares all that is in it. The textbook's number \
         of tests stands beside it.",
    ],
    depth: [
        "How many surfaces lie behind one another at each pixel.",
        "Object order meets all of them and keeps one; image order may stop early. The mean is what overdraw costs.",
    ],
    work: [
        "The same picture, and how many tests each pixel takes.",
        "The textbooks test every pair: both loops do the same work, in another order. Bounds and hierarchies save nearly all of \
         it. The numbers count each primitive and each ray by itself; a timed frame shares more.",
    ],
    hierarchy: [
        "Boxes, so that most pairs are never looked at.",
        "Each order skips its own inner loop: image order skips objects by boxes around them, object order skips pixels by \
         boxes and tiles on the raster.",
    ],
    order: [
        "The pixels in the order in which each loop decided them.",
        "This is the swap of the loops, seen as colour: objects on one side, lines on the other. With tiles and hierarchies the \
         patterns change, and the picture stays the same.",
    ],
    triangles: [
        "The textbooks grow with the triangles; the fast renderers hardly do.",
        "Steps are counted, so this chart is the same on every machine. A slope of 1 means: twice the triangles, twice the \
         work. Ask what a hierarchy must do so that the slope is near 0, and what no hierarchy can avoid.",
    ],
    pixels: [
        "With more pixels every loop has more to do.",
        "Here no hierarchy helps: each pixel is decided at least once. For times, run bothways sweep on the machine in the room.",
    ],
    agree: [
        "Both orders cover the same samples and see the same primitive in each.",
        "The difference is computed, not claimed: ids are compared without tolerance. They agree because what is true of a sample \
         is decided by exact arithmetic, in one place, and neither loop can change it.",
    ],
    reasons: [
        "A common rule, 'inside or on the edge', and each pixel that it gets wrong.",
        "Here object order counts edges as inside on both sides. Each coloured pixel has a reason that the exact judge \
         found. Most bug reports about renderers are of this kind.",
    ],
    zoom: [
        "The same pixels in every buffer.",
        "Coverage can agree while ids do not: the union of shared edges is the same, and the owner is not. A picture alone would \
         hide it.",
    ],
    film: [
        "Both loops draw one picture, on one clock of work done.",
        "Let it run twice. First watch the pictures, then the lit lines. Ask before the end: when does either order know that it \
         is finished?",
    ],
    fast_film: [
        "The same with bounds and hierarchies.",
        "The clock counts tests of primitives and boxes, each ray by itself. It is no clock of seconds: one step of one order may \
         take longer than one of the other.",
    ],
};
