//! Why files of a renderer are wrong: conventions that explain many of them at once, then the reasons of the pixels of each.

use super::found::{Cause, Certainty, CheckedFile};
use super::truth::truth;
use crate::common::{Camera, Scene, View};
use crate::diff::foreign::{Aspect, Buffer, CompareOptions, Content, compare_with, ids_of_floats};
use crate::diff::why::{
    Change, CommonExplanation, ReasonKind, Rendering, camera_of_samples, find_common_conventions,
    find_reasons_of_samples,
};
use std::borrow::Cow;

/// The causes of what is wrong, and the files of each.
pub(super) fn find(files: &[CheckedFile], scenes: &[(Scene, Camera)]) -> Vec<Cause> {
    let looks: Vec<Look> =
        (0..files.len()).filter_map(|at| Look::new(at, &files[at], &scenes[at])).collect();
    let wrong: Vec<usize> = (0..looks.len()).filter(|&at| !looks[at].is_right).collect();
    if wrong.is_empty() {
        return Vec::new();
    }
    let views: Vec<View> = looks.iter().map(|look| View::new(look.scene, &look.camera)).collect();
    let (of_floats, wrong) = ids_as_floats(&looks, &views, wrong);
    let (mut causes, left) = common(&looks, &views, wrong);
    causes.extend(of_floats);
    for at in left {
        let Some((sentence, certainty)) = looks[at].of_pixels(&views[at]) else { continue };
        let file = looks[at].file;
        let is_same = |cause: &&mut Cause| {
            cause.certainty == certainty && cause.alternatives[0][0] == sentence
        };
        match causes.iter_mut().find(is_same) {
            Some(cause) => cause.files.push(file),
            None => {
                let alternatives = vec![vec![sentence]];
                causes.push(Cause { alternatives, certainty, files: vec![file] });
            }
        }
    }
    causes.sort_by_key(|cause| {
        (cause.certainty == Certainty::Unknown, std::cmp::Reverse(cause.files.len()))
    });
    causes
}

/// The cause of files whose distances are ids, and the other files that are wrong. One number alone tells little: the files must be
/// most of those that hold distances, and one of them must show several ids.
fn ids_as_floats(looks: &[Look], views: &[View], wrong: Vec<usize>) -> (Option<Cause>, Vec<usize>) {
    let holds_distances = |at: &&usize| looks[**at].theirs.tells(Aspect::T);
    let all = wrong.iter().filter(holds_distances).count();
    let meant = |at: usize| ids_of_floats(&looks[at].theirs, &looks[at].true_ids(&views[at])?);
    let ids: Vec<Option<Buffer>> = wrong.iter().map(|&at| meant(at)).collect();
    let are_several = |ids: &Buffer| {
        let Content::Ids(ids) = ids.content() else { return false };
        let mut shown = ids.iter().flatten();
        shown.next().is_some_and(|first| shown.any(|id| id != first))
    };
    let found = ids.iter().flatten().count();
    if 2 * found <= all || !ids.iter().flatten().any(are_several) {
        return (None, wrong);
    }
    let (of_ids, left): (Vec<_>, Vec<_>) =
        wrong.into_iter().zip(&ids).partition(|(_, ids)| ids.is_some());
    let sentence = "it saves ids as floating-point numbers, which are read as distances: save them as integers \
                    (astype('uint32'))";
    let cause = Cause {
        alternatives: vec![vec![sentence.into()]],
        certainty: Certainty::Reason,
        files: of_ids.into_iter().map(|(at, _)| looks[at].file).collect(),
    };
    (Some(cause), left.into_iter().map(|(at, _)| at).collect())
}

/// The cause that many of the wrong files have in common, if there is one, and the files that it leaves.
fn common(looks: &[Look], views: &[View], wrong: Vec<usize>) -> (Vec<Cause>, Vec<usize>) {
    let renderings: Vec<Rendering> = looks
        .iter()
        .zip(views)
        .map(|(look, view)| Rendering { view, file: &look.theirs })
        .collect();
    let mut common = find_common_conventions(&renderings);
    let Some(first) = common.first().cloned() else { return (Vec::new(), wrong) };
    // What explains other files is another cause, of which nothing is said.
    common.retain(|one| one.agrees == first.agrees);
    let is_a_guess = first.is_a_guess(wrong.len());
    let (explained, left): (Vec<usize>, Vec<usize>) =
        wrong.into_iter().partition(|&at| first.agrees[at]);
    let several = explained.iter().any(|&at| looks[at].samples > 1);
    let cause = Cause {
        alternatives: common.iter().map(|one| sentences(one, several)).collect(),
        certainty: if is_a_guess { Certainty::Guess } else { Certainty::Convention },
        files: explained.into_iter().map(|at| looks[at].file).collect(),
    };
    (vec![cause], left)
}

/// An explanation in sentences; `several` tells whether some of its files have several samples a pixel.
fn sentences(one: &CommonExplanation, several: bool) -> Vec<String> {
    let mut sentences = one.sentences("it");
    let counts = |change: &Change| matches!(change, Change::Columns(_) | Change::Rows(_));
    if several && one.convention.changes().iter().any(counts) {
        sentences.push("in files of several samples a pixel, i and j count the samples".into());
    }
    sentences
}

/// A file as its causes are searched: each sample is a pixel.
struct Look<'a> {
    /// The place of the file among all files.
    file: usize,
    scene: &'a Scene,
    camera: Camera,
    samples: u32,
    theirs: Cow<'a, Buffer<'static>>,
    /// The exact picture; `None` if the file has another size, with rows and columns exchanged.
    truth: Option<Cow<'a, Buffer<'static>>>,
    is_right: bool,
}

impl<'a> Look<'a> {
    /// `None` for a file that cannot be searched for causes.
    fn new(
        at: usize,
        file: &'a CheckedFile,
        (scene, camera): &'a (Scene, Camera),
    ) -> Option<Look<'a>> {
        let (theirs, truth, is_right) = match &file.compared {
            Ok(compared) => (&compared.theirs, Some(&compared.truth), compared.comparison.equal),
            Err(error) => (error.exchanged.as_ref()?, None, false),
        };
        let samples = theirs.samples();
        let camera = camera_of_samples(camera, samples);
        Some(Look {
            file: at,
            scene,
            camera: camera?,
            samples,
            theirs: by_sample(theirs),
            truth: truth.map(by_sample),
            is_right,
        })
    }

    /// The ids of the exact picture, for a file of distances.
    fn true_ids(&self, view: &View) -> Option<Buffer<'static>> {
        let is_of_distances = self.truth.is_some() && self.theirs.tells(Aspect::T);
        is_of_distances.then_some(())?;
        let [width, height] = self.theirs.size();
        let ids = vec![None; width as usize * height as usize];
        let like = Buffer::new([width, height], 1, Content::Ids(ids));
        truth(view, &like).ok()
    }

    /// The reason of most differing pixels; `None` for a file of another size, which says itself why it is wrong.
    fn of_pixels(&self, view: &View) -> Option<(String, Certainty)> {
        let truth = self.truth.as_ref()?;
        let options = CompareOptions { only_compares: true, ..CompareOptions::default() };
        let comparison = compare_with(&self.theirs, truth, &options).expect("it was compared");
        let differing: Vec<[u32; 2]> =
            comparison.classes().differing().map(|(pixel, _)| pixel).collect();
        let reasons = find_reasons_of_samples(view, &self.theirs, truth, &differing, self.samples);
        let reasons = match reasons {
            Ok(reasons) => reasons,
            Err(error) => return Some((format!("unexplained: {error}"), Certainty::Unknown)),
        };
        let known = |kind: ReasonKind| {
            !matches!(
                kind,
                ReasonKind::Unexplained | ReasonKind::CannotTell | ReasonKind::WithinTolerance
            )
        };
        let most = reasons.counts().into_iter().max_by_key(|&(_, pixels)| pixels);
        Some(match most {
            Some((kind, pixels)) if known(kind) && 2 * pixels > reasons.differing => {
                let things = if self.samples == 1 { "pixels" } else { "samples" };
                (format!("most of the {things}: {}", kind.name()), Certainty::Reason)
            }
            _ => ("unexplained by what is known here".into(), Certainty::Unknown),
        })
    }
}

/// A file with each sample as a pixel.
fn by_sample<'a>(file: &'a Buffer<'static>) -> Cow<'a, Buffer<'static>> {
    match file.samples() {
        1 => Cow::Borrowed(file),
        _ => Cow::Owned(file.samples_as_pixels().expect("a file is no frame")),
    }
}
