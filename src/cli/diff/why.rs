//! `bothways diff A B --scene SCENE`: why the files differ, by the scene that they show.

use super::inputs::{self, SceneArgs};
use super::text::line;
use crate::cli::args::ProjectionArg;
use crate::cli::failure::Failure;
use crate::cli::shell::quoted;
use anstyle::Style;
use bothways::common::{Camera, Crop, Scene, View};
use bothways::diff::foreign::{
    Buffer, BufferComparison, CompareOptions, Content, Side, compare_with, exchanged_sides,
};
use bothways::diff::page::{Group, Page};
use bothways::diff::why::{
    Explanation, Finding, Findings, PixelReason, Reason, ReasonKind, Reasons, Wrong,
    camera_of_samples, cause_of_size, find_conventions, find_reasons_of_samples,
};
use bothways::figure::{Entry, with_legend};
use bothways::picture::enlarged;
use bothways::wording::{count, grouped};
use image::{Rgb, RgbImage};
use serde::Serialize;

/// Two files of several samples a pixel, and their scene, with each sample as a pixel of its own.
pub(super) struct BySample {
    samples: u32,
    files: [Buffer<'static>; 2],
    camera: Camera,
    comparison: BufferComparison,
}

impl BySample {
    /// `None` if there is one sample a pixel, or no scene to explain anything with.
    pub(super) fn new(
        [a, b]: [&Buffer<'static>; 2],
        options: &CompareOptions,
        camera: Option<&Camera>,
    ) -> Result<Option<BySample>, Failure> {
        let samples = a.samples();
        let Some(camera) = camera.filter(|_| samples > 1 && b.samples() == samples) else {
            return Ok(None);
        };
        let (Some(a), Some(b)) = (a.samples_as_pixels(), b.samples_as_pixels()) else {
            return Ok(None);
        };
        // Another size has its own message, and what is too large is not looked at sample by sample.
        let camera = camera_of_samples(camera, samples);
        let Some(camera) = camera.filter(|camera| camera.image() == a.size()) else {
            return Ok(None);
        };
        let scaled = |crop: &Crop| Crop {
            row: crop.row * samples,
            column: crop.column * samples,
            height: crop.height * samples,
            width: crop.width * samples,
        };
        let ignored = options.ignored.iter().map(scaled).collect();
        let options = CompareOptions { ignored, only_compares: true, ..options.clone() };
        let comparison = compare_with(&a, &b, &options)
            .map_err(|error| Failure::new(format!("sample by sample: {error}")))?;
        Ok(Some(BySample { samples, files: [a, b], camera, comparison }))
    }

    /// Why the samples differ.
    pub(super) fn why<'a>(&'a self, scene: &'a Scene, words: String) -> Why<'a> {
        let [a, b] = &self.files;
        let view = View::new(scene, &self.camera);
        let samples = self.samples;
        let words = format!("{words} --samples {samples}");
        Why::find(&view, [a, b], &self.comparison, words, samples)
    }

    /// The comparison of samples.
    pub(super) fn comparison(&self) -> &BufferComparison {
        &self.comparison
    }
}

/// Why two files differ.
pub(super) struct Why<'a> {
    camera: &'a Camera,
    /// Samples along a side of a pixel. If there are several, each counts as a pixel in what follows.
    samples: u32,
    /// Whether A and B are pictures, of which coverage alone is held against the scene.
    are_pictures: [bool; 2],
    /// Whether one of the files is empty, or as a whole not what it is read as: then the reasons of its single pixels mislead.
    is_wrong_as_a_whole: bool,
    /// The scene and the camera's options, as they were given: what `bothways pixel` needs.
    scene: String,
    /// The conventions of A and of B, or why they cannot be found.
    conventions: [Result<Findings, String>; 2],
    /// The reasons of the differing pixels, or why there are none.
    reasons: Result<Reasons, String>,
}

impl<'a> Why<'a> {
    /// Searches for reasons and conventions.
    pub(super) fn find(
        view: &View<'a>,
        [a, b]: [&Buffer; 2],
        comparison: &BufferComparison,
        scene: String,
        samples: u32,
    ) -> Why<'a> {
        let differing: Vec<[u32; 2]> =
            comparison.classes().differing().map(|(pixel, _)| pixel).collect();
        let conventions =
            [a, b].map(|file| find_conventions(view, file).map_err(|error| error.to_string()));
        let mut reasons = find_reasons_of_samples(view, a, b, &differing, samples)
            .map_err(|error| error.to_string());
        for (side, found) in [Side::A, Side::B].into_iter().zip(&conventions) {
            if let (Ok(reasons), Ok(Findings { differing, finding: Finding::Explained(found), .. })) =
                (&mut reasons, found)
                && !found[0].is_a_guess(*differing)
            {
                reasons.explained_by(side, &found[0]);
            }
        }
        let is_picture = |file: &Buffer| matches!(file.content(), Content::Picture(_));
        let are_pictures = [a, b].map(is_picture);
        let covered = comparison.coverage.map_or([1; 2], |covered| [covered.a, covered.b]);
        // A mask that covers all may be right in most pixels.
        let misleads = |side: usize| {
            let finding = conventions[side].as_ref().map(|found| &found.finding);
            let is_mask = matches!([a, b][side].content(), Content::Mask(_));
            matches!(finding, Ok(Finding::NoEvidence(_))) && !(is_mask && covered[side] > 0)
        };
        let is_wrong_as_a_whole = misleads(0) || misleads(1);
        Why {
            camera: view.camera,
            samples,
            are_pictures,
            is_wrong_as_a_whole,
            scene,
            conventions,
            reasons,
        }
    }

    /// The report as text: reasons, conventions, and the next step.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        match &self.reasons {
            // That some pixels of an empty file would lie near edges says nothing of why it is empty.
            Ok(_) if self.is_wrong_as_a_whole => text.push('\n'),
            Ok(reasons) => self.table(reasons, &mut text),
            Err(error) => line(&mut text, format_args!("no reasons: {error}")),
        }
        for (name, found) in ["A", "B"].into_iter().zip(&self.conventions) {
            match found {
                Ok(findings) => self.conventions_of(name, findings, &mut text),
                Err(error) => line(&mut text, format_args!("no conventions of {name}: {error}")),
            }
        }
        if let Some(sample) = self.telling() {
            line(&mut text, format_args!("{}", self.command(self.pixel_of(sample))));
        }
        text
    }

    /// The file that shows what is true of the scene, if the other one does not.
    pub(super) fn right_side(&self) -> Option<Side> {
        let is_true = self
            .conventions
            .each_ref()
            .map(|found| found.as_ref().is_ok_and(|findings| findings.finding == Finding::True));
        match is_true {
            [true, false] => Some(Side::A),
            [false, true] => Some(Side::B),
            _ => None,
        }
    }

    /// Whether the scene explains neither file: what both look like beside each other may say more.
    pub(super) fn explains_nothing(&self) -> bool {
        let explains = |(found, is_picture): (&Findings, bool)| match found.finding {
            Finding::True | Finding::Unexplained(_) => false,
            // The colours of a picture may say what its coverage does not.
            Finding::NoEvidence(_) => !is_picture,
            Finding::Rounded | Finding::Explained(_) => true,
        };
        let found = self.conventions.iter().zip(self.are_pictures);
        !found.filter_map(|(found, is)| Some((found.as_ref().ok()?, is))).any(explains)
    }

    /// The pixel of a sample.
    fn pixel_of(&self, sample: [u32; 2]) -> [u32; 2] {
        sample.map(|number| number / self.samples)
    }

    /// The command that derives a pixel.
    fn command(&self, [i, j]: [u32; 2]) -> String {
        format!("see why: bothways pixel {} {i} {j}", self.scene)
    }

    /// What is counted: pixels, or samples.
    fn things(&self) -> &'static str {
        if self.samples == 1 { "pixels" } else { "samples" }
    }

    fn table(&self, reasons: &Reasons, text: &mut String) {
        if reasons.pixels.is_empty() {
            return;
        }
        text.push('\n');
        let mut columns =
            vec![("A is wrong", Wrong::A), ("B is wrong", Wrong::B), ("both", Wrong::Both)];
        if reasons.pixels.iter().any(|one| one.wrong == Wrong::Neither) {
            columns.push(("neither", Wrong::Neither));
        }
        let heads: String = columns.iter().map(|(head, _)| format!("{head:>12}")).collect();
        let bold = Style::new().bold();
        let head = if self.samples == 1 { "reasons" } else { "reasons, by sample" };
        line(text, format_args!("{bold}{head:34}{heads}{bold:#}"));
        for kind in reasons.counts().into_iter().map(|(kind, _)| kind) {
            let number = |&(_, wrong): &(&str, Wrong)| {
                format!("{:>12}", grouped(reasons.count(kind, wrong)))
            };
            let numbers: String = columns.iter().map(number).collect();
            line(text, format_args!("{:34}{numbers}{}", kind.name(), farthest(reasons, kind)));
        }
        if reasons.is_partial() {
            let looked = grouped(reasons.pixels.len() as u64);
            line(
                text,
                format_args!(
                    "({looked} {} were looked at, spread evenly; the numbers are scaled)",
                    self.things()
                ),
            );
        }
        text.push('\n');
    }

    fn conventions_of(&self, name: &str, findings: &Findings, text: &mut String) {
        let Findings { pixels, differing, finding } = findings;
        let all = grouped(*pixels);
        let things = self.things();
        let wrong = count(*differing, things);
        match finding {
            Finding::True if self.are_pictures[usize::from(name == "B")] => line(
                text,
                format_args!(
                    "{name} covers what the scene does in all {all} {things}; its colours are not held against the scene"
                ),
            ),
            Finding::True => line(
                text,
                format_args!("{name} shows what is true of the scene in all {all} {things}"),
            ),
            Finding::NoEvidence(reason) => {
                line(text, format_args!("{name} says nothing about conventions: {reason}"));
            }
            Finding::Rounded => line(
                text,
                format_args!(
                    "{name} is wrong in {wrong}, by rounding alone: its conventions are those of the scene"
                ),
            ),
            Finding::Unexplained(place) => {
                let place = place.as_ref().map_or(", and".into(), |place| format!("; {place};"));
                line(
                    text,
                    format_args!(
                        "{name} is wrong in {wrong}{place} no convention that is known here explains a quarter of them"
                    ),
                );
            }
            Finding::Explained(explanations) => {
                self.explanations(name, *differing, explanations, text);
            }
        }
    }

    fn explanations(&self, name: &str, differing: u64, found: &[Explanation], text: &mut String) {
        let wrong = count(differing, self.things());
        let guess = found[0].is_a_guess(differing);
        let how = match (found.len(), guess) {
            (1, false) => "one explanation fits best",
            (1, true) => "a guess, which explains less than half",
            (_, false) if found.iter().any(|one| one.remaining != found[0].remaining) => {
                "these explain nearly equally much, and the files cannot tell which it is"
            }
            (_, false) => "these explain equally much, and the files cannot tell which it is",
            (_, true) => "guesses, which explain less than half",
        };
        let unit = match self.samples {
            1 => String::new(),
            n => format!(" (i and j count samples here, and W and H are {n} times as large)"),
        };
        line(text, format_args!("{name} is wrong in {wrong}; {how}{unit}:"));
        for one in found {
            let sentences = one.sentences(name, self.camera);
            for (index, sentence) in sentences.iter().enumerate() {
                let mark = if index == 0 { "-" } else { "  and" };
                line(text, format_args!("  {mark} {sentence}"));
            }
            let explained = grouped(one.explained);
            let rest = match one.remaining {
                0 => "nothing remains".into(),
                1 => format!("{} remains", count(1, self.things())),
                more => format!("{} remain", count(more, self.things())),
            };
            // What explains a part may be another cause.
            let doubt = if 10 * one.remaining > differing {
                ": something else is wrong, too, or instead"
            } else {
                ""
            };
            line(
                text,
                format_args!("    explains {explained} of {}; {rest}{doubt}", grouped(differing)),
            );
        }
    }

    /// The pixel that says most: one that the conventions of a file explain, else the first with a reason.
    pub(super) fn telling(&self) -> Option<[u32; 2]> {
        let explained = self.conventions.iter().flatten().find_map(|found| match &found.finding {
            Finding::Explained(explanations) => explanations[0].telling(),
            _ => None,
        });
        let known =
            |one: &&PixelReason| !matches!(one.reason, Reason::Unexplained | Reason::CannotTell);
        let reasons = self.reasons.as_ref().map_or(&[][..], |reasons| &reasons.pixels);
        let first = reasons.iter().find(known).or(reasons.first());
        explained.or(first.map(|one| one.pixel))
    }

    /// The evidence of one pixel. `comparison` is of the samples, if there are several a pixel.
    pub(super) fn pixel(&self, pixel: [u32; 2], comparison: &BufferComparison) -> String {
        let [i, j] = pixel;
        let reasons = match &self.reasons {
            Ok(reasons) => reasons,
            Err(error) => return format!("no reason for ({i}, {j}): {error}\n"),
        };
        let of_pixel = reasons.pixels.iter().filter(|one| self.pixel_of(one.pixel) == pixel);
        let found: Vec<String> = of_pixel.map(|one| self.evidence(one)).collect();
        if found.is_empty() {
            let mut differing = comparison.classes().differing();
            if !differing.any(|(one, _)| self.pixel_of(one) == pixel) {
                return format!("the files do not differ at ({i}, {j})\n");
            }
            let (looked_at, things) = (grouped(reasons.pixels.len() as u64), self.things());
            let all = grouped(reasons.differing);
            return format!(
                "the files differ at ({i}, {j}), which is not among the {looked_at} of {all} differing {things} that \
                 were looked at\n{}\n",
                self.command(pixel)
            );
        }
        found.concat() + &self.command(pixel) + "\n"
    }

    /// Why one pixel, or one sample, differs.
    fn evidence(&self, found: &PixelReason) -> String {
        let wrong = match found.wrong {
            Wrong::A => "A is wrong",
            Wrong::B => "B is wrong",
            Wrong::Both => "both are wrong",
            Wrong::Neither => "neither is known to be wrong",
        };
        let truth = found.truth.map_or("nothing".into(), |id| format!("id {id}"));
        let [i, j] = self.pixel_of(found.pixel);
        let sample = match self.samples {
            1 => String::new(),
            samples => {
                let [row, column] = found.pixel.map(|number| number % samples);
                format!(", sample ({row}, {column}) of it")
            }
        };
        let reason = found.reason.sentence();
        format!("({i}, {j}){sample}: {truth} is seen in truth; {wrong}: {reason}\n")
    }

    /// The pixels of each kind of reason.
    pub(super) fn groups(&self) -> Vec<(ReasonKind, Vec<[u32; 2]>)> {
        let Ok(reasons) = &self.reasons else { return Vec::new() };
        let of = |kind: ReasonKind| {
            let some = reasons.pixels.iter().filter(move |one| one.reason.kind() == kind);
            (kind, some.map(|one| one.pixel).collect::<Vec<_>>())
        };
        let groups = ReasonKind::ALL.into_iter().map(of);
        groups.filter(|(_, pixels)| !pixels.is_empty()).collect()
    }

    /// The difference image, coloured by reason, with a legend.
    pub(super) fn picture(&self, comparison: &BufferComparison) -> RgbImage {
        let mut picture = comparison.picture();
        let groups = self.groups();
        for (kind, pixels) in &groups {
            for &[i, j] in pixels {
                picture.put_pixel(j, i, Rgb(kind.color()));
            }
        }
        let counts = self.reasons.as_ref().map_or(Vec::new(), Reasons::counts);
        let entries: Vec<Entry> = counts
            .into_iter()
            .map(|(kind, pixels)| Entry { color: kind.color(), name: kind.name(), pixels })
            .collect();
        with_legend(&enlarged(picture), &entries)
    }

    /// Puts reasons, conventions and the next step into a page.
    pub(super) fn fill(&self, page: &mut Page) {
        let groups = self.groups();
        if !groups.is_empty() {
            let group = |(kind, samples): (ReasonKind, Vec<[u32; 2]>)| {
                let mut pixels: Vec<[u32; 2]> =
                    samples.into_iter().map(|sample| self.pixel_of(sample)).collect();
                pixels.sort_unstable();
                pixels.dedup();
                let (name, color) = (kind.name().into(), kind.color());
                Group { name, explanation: None, color, pixels }
            };
            page.groups = groups.into_iter().map(group).collect();
        }
        let mut findings = Vec::new();
        for (name, found) in ["A", "B"].into_iter().zip(&self.conventions) {
            match found {
                Ok(Findings { differing, finding: Finding::Explained(found), .. }) => {
                    let all = found.iter().map(|one| {
                        let parts = one.sentences(name, self.camera).join("; and ");
                        let explained = grouped(one.explained);
                        format!(
                            "{parts} (explains {explained} of {})",
                            count(*differing, self.things())
                        )
                    });
                    findings.push(all.collect::<Vec<_>>().join(", or: "));
                }
                Ok(found) => {
                    let mut text = String::new();
                    self.conventions_of(name, found, &mut text);
                    findings.push(text.trim().to_owned());
                }
                Err(error) => findings.push(format!("no conventions of {name}: {error}")),
            }
        }
        page.findings = findings;
        page.why = Some(format!("bothways pixel {}", self.scene));
    }

    /// The report for programs.
    pub(super) fn json(&self) -> WhyJson {
        WhyJson {
            reasons: self.reasons.as_ref().ok().map(|reasons| {
                let counts = reasons.counts().into_iter();
                counts.map(|(kind, pixels)| ReasonJson { kind, pixels }).collect()
            }),
            a: self.file_json("A", &self.conventions[0]),
            b: self.file_json("B", &self.conventions[1]),
            samples: self.samples,
            telling: self.telling().map(|sample| self.pixel_of(sample)),
        }
    }

    fn file_json(&self, name: &str, found: &Result<Findings, String>) -> FileJson {
        let (differing, finding, note, explanations) = match found {
            Err(error) => (None, "not_searched", Some(error.clone()), &[][..]),
            Ok(Findings { differing, finding, .. }) => match finding {
                Finding::True => (Some(*differing), "true", None, &[][..]),
                Finding::NoEvidence(reason) => {
                    (Some(*differing), "no_evidence", Some(reason.clone()), &[][..])
                }
                Finding::Rounded => (Some(*differing), "rounding", None, &[][..]),
                Finding::Unexplained(place) => {
                    (Some(*differing), "unexplained", place.clone(), &[][..])
                }
                Finding::Explained(found) => {
                    let guess = found[0].is_a_guess(*differing);
                    (Some(*differing), if guess { "guess" } else { "explained" }, None, &found[..])
                }
            },
        };
        let explanations = explanations.iter().map(|one| ExplanationJson {
            sentences: one.sentences(name, self.camera),
            explained: one.explained,
            remaining: one.remaining,
        });
        FileJson { wrong_pixels: differing, finding, note, explanations: explanations.collect() }
    }
}

/// `, at most 0.004 pixels from an edge`.
fn farthest(reasons: &Reasons, kind: ReasonKind) -> String {
    let farthest = reasons.pixels.iter().filter_map(|one| match one.reason {
        Reason::Rounding { pixels, .. } if kind == ReasonKind::Rounding => Some(pixels),
        _ => None,
    });
    let farthest = farthest.fold(f64::NAN, f64::max);
    if farthest.is_nan() {
        String::new()
    } else {
        format!("  (at most {farthest:.2e} pixels away)")
    }
}

/// Reasons and conventions for programs.
#[derive(Serialize)]
pub(super) struct WhyJson {
    reasons: Option<Vec<ReasonJson>>,
    a: FileJson,
    b: FileJson,
    /// Samples along a side of a pixel; if there are several, samples are counted.
    samples: u32,
    telling: Option<[u32; 2]>,
}

#[derive(Serialize)]
struct ReasonJson {
    kind: ReasonKind,
    pixels: u64,
}

#[derive(Serialize)]
struct FileJson {
    wrong_pixels: Option<u64>,
    finding: &'static str,
    note: Option<String>,
    explanations: Vec<ExplanationJson>,
}

#[derive(Serialize)]
struct ExplanationJson {
    sentences: Vec<String>,
    explained: u64,
    remaining: u64,
}

/// What may explain that two files have different sizes, in words behind the error; empty if nothing does.
pub(super) fn of_sizes(args: &SceneArgs, [a, b]: [&Buffer; 2]) -> String {
    let scene = inputs::scene_of_size(args, None, Some(a.size())).ok().flatten();
    let view = scene.as_ref().map(|(loaded, camera)| View::new(&loaded.scene, camera));
    // With the scene, each file can be held to what is true; without it, only to the other file.
    let by_scene = cause_of_size("B", b, a.size(), view.as_ref());
    let causes = by_scene.map_or_else(|| exchanged_sides(a, b), |cause| vec![cause]);
    if causes.is_empty() { String::new() } else { format!("; {}", causes.join(", or ")) }
}

/// The scene and the options of its camera, as `bothways pixel` takes them.
pub(super) fn arguments(args: &SceneArgs, files: [u32; 2]) -> String {
    let SceneArgs { scene, files: read, camera } = args;
    let mut words: Vec<String> = scene.iter().map(|scene| quoted(scene)).collect();
    let mut add = |name: &str, value: Option<String>| {
        words.extend(value.map(|value| format!("--{name} {value}")));
    };
    let list = |numbers: &[f32]| numbers.iter().map(f32::to_string).collect::<Vec<_>>().join(",");
    let [width, height] = camera.size.unwrap_or(files);
    add("size", Some(format!("{width}x{height}")));
    let projection = camera.projection.map(|projection| match projection {
        ProjectionArg::Perspective => "perspective",
        ProjectionArg::Parallel => "parallel",
    });
    add("projection", projection.map(str::to_owned));
    add("eye", camera.eye.map(|eye| list(&eye.to_array())));
    add("look-at", camera.look_at.map(|target| list(&target.to_array())));
    add("up", camera.up.map(|up| list(&up.to_array())));
    add("distance", camera.distance.map(|distance| distance.to_string()));
    add("viewport", camera.viewport.map(|viewport| list(&viewport)));
    add("fov", camera.fov.map(|fov| fov.to_string()));
    if read.allow_outside {
        words.push("--allow-outside".to_owned());
    }
    words.join(" ")
}
