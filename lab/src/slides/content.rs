//! What is on each slide, in the order of the lecture, and how it is drawn.

use super::error::SlideError;
use super::stills;
use super::words::{self, Words};
use crate::common::{Camera, Projection, View};
use crate::figure::{Drawing, Kind, Subject, Theme, sweep_chart};
use crate::film::{Film, Length, default_size};
use crate::orders::{Method, Order, Rules};
use crate::scenes::{self, LoadedScene};
use crate::sweep::{self, Axis, Bench, Quantity, Summary, Table};

/// A slide that is drawn.
#[derive(Debug)]
pub enum Content {
    /// A drawing, as SVG.
    Drawing(Box<Drawing>),
    /// A film, as GIF.
    Film(Vec<u8>),
}

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
        [caption, notes]: Words,
        scene: Shown<'a>,
        what: What,
    ) -> Planned<'a> {
        let plan =
            Plan { scene, what, projection: None, rules: Rules::default(), pixels: Vec::new() };
        Planned { name: name.into(), title: title.into(), caption, notes, plan }
    }
}

/// A slide of the lecture, before it has its scene.
struct Topic {
    name: &'static str,
    title: &'static str,
    words: Words,
    what: What,
    /// The built-in scene that shows it; `None` for the lecture's first scene.
    scene: Option<&'static str>,
    projection: Option<Projection>,
    /// The rule of object order, by its name.
    rule: Option<&'static str>,
}

impl Topic {
    const fn new(name: &'static str, title: &'static str, words: Words, what: What) -> Topic {
        Topic { name, title, words, what, scene: None, projection: None, rule: None }
    }

    const fn of(self, scene: &'static str) -> Topic {
        Topic { scene: Some(scene), ..self }
    }

    const fn projected(self, projection: Projection) -> Topic {
        Topic { projection: Some(projection), ..self }
    }

    const fn ruled(self, object_order: &'static str) -> Topic {
        Topic { rule: Some(object_order), ..self }
    }

    fn planned<'a>(&self, first: &'a LoadedScene) -> Result<Planned<'a>, SlideError> {
        let scene = match self.scene {
            Some(name) => built_in(name)?,
            None => Shown::Given(first),
        };
        let mut planned = Planned::new(self.name, self.title, self.words, scene, self.what);
        planned.plan.projection = self.projection;
        if let Some(rule) = self.rule {
            let parsed = rule.parse().map_err(|error| SlideError(format!("{rule}: {error}")))?;
            planned.plan.rules.object_order = Some(parsed);
        }
        Ok(planned)
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

/// The lecture, slide by slide.
const LECTURE: [Topic; 18] = [
    Topic::new("image", "What is an image?", words::IMAGE, What::Figure(Kind::Image)),
    Topic::new("object-order", "Object order", words::OBJECT_ORDER, What::Stills(Order::Object)),
    Topic::new("image-order", "Image order", words::IMAGE_ORDER, What::Stills(Order::Image)),
    Topic::new(
        "camera-perspective",
        "The camera: perspective",
        words::PERSPECTIVE,
        What::Figure(Kind::Camera),
    )
    .projected(Projection::Perspective),
    Topic::new(
        "camera-parallel",
        "The camera: parallel",
        words::PARALLEL,
        What::Figure(Kind::Camera),
    )
    .projected(Projection::Parallel),
    Topic::new(
        "edge-functions",
        "Coverage: three half-planes",
        words::EDGES,
        What::Figure(Kind::EdgeFunctions),
    ),
    Topic::new("grid", "Coverage: samples", words::GRID, What::Figure(Kind::Grid)),
    Topic::new("ties", "The tie rule", words::TIES, What::Figure(Kind::Grid)).of("ties"),
    Topic::new("ray", "The nearest along a ray", words::RAY, What::Figure(Kind::Ray)),
    Topic::new(
        "depth-complexity",
        "Depth complexity",
        words::DEPTH,
        What::Figure(Kind::DepthComplexity),
    ),
    Topic::new("work", "Work", words::WORK, What::Figure(Kind::Work)),
    Topic::new("hierarchy", "Skipping work", words::HIERARCHY, What::Figure(Kind::Hierarchy)),
    Topic::new("order", "When is a pixel decided?", words::ORDER, What::Figure(Kind::Order)),
    Topic::new(
        "cost-triangles",
        "Cost: more triangles",
        words::TRIANGLES,
        What::Sweep(Axis::Triangles),
    ),
    Topic::new("cost-pixels", "Cost: more pixels", words::PIXELS, What::Sweep(Axis::Pixels)),
    Topic::new("agree", "Both orders agree", words::AGREE, What::Figure(Kind::SideBySide)),
    Topic::new(
        "reasons",
        "When real systems do not agree",
        words::REASONS,
        What::Figure(Kind::Reasons),
    )
    .of("ties")
    .ruled("inclusive"),
    Topic::new("zoom", "What it looks like", words::ZOOM, What::Figure(Kind::Zoom))
        .of("ties")
        .ruled("inclusive"),
];

/// Its films.
const FILMS: [Topic; 2] = [
    Topic::new(
        "film-textbook",
        "Film: the textbook's loops",
        words::FILM,
        What::Film(Method::Textbook),
    ),
    Topic::new("film-fast", "Film: the fast renderers", words::FAST_FILM, What::Film(Method::Fast)),
];

/// The lecture with its first scene.
fn lecture(first: &LoadedScene, films: bool) -> Result<Vec<Planned<'_>>, SlideError> {
    let topics = LECTURE.iter().chain(FILMS.iter().filter(|_| films));
    let mut plans = topics.map(|topic| topic.planned(first)).collect::<Result<Vec<_>, _>>()?;
    // A scene of planes and spheres has no edges, and one of planes alone no boxes: those slides would be empty.
    plans.retain(|planned| planned.plan.applies());
    Ok(plans)
}

/// What differs from scene to scene.
fn chapter(scene: &LoadedScene, films: bool) -> Vec<Planned<'_>> {
    let kinds = [
        (Kind::SideBySide, "both orders", words::AGREE),
        (Kind::Camera, "the camera", words::CAMERA),
        (Kind::DepthComplexity, "depth complexity", words::DEPTH),
        (Kind::Work, "work", words::WORK),
        (Kind::Hierarchy, "skipping work", words::HIERARCHY),
        (Kind::Order, "when is a pixel decided?", words::ORDER),
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
            words::FAST_FILM,
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
            What::Figure(Kind::EdgeFunctions) => shapes.any(|shape| {
                matches!(shape, Shape::Triangle(_) | Shape::Mesh(_) | Shape::Instances(_))
            }),
            What::Figure(Kind::Hierarchy) => shapes.any(|shape| !matches!(shape, Shape::Plane(_))),
            // The textbook of a large scene takes too long; its still would be of a handful of pixels.
            What::Stills(_) | What::Film(Method::Textbook) => {
                loaded.scene.primitive_count() <= 60_000
            }
            What::Figure(_) | What::Film(Method::Fast) | What::Sweep(_) => true,
        }
    }
}
