//! Which channels of an EXR are read, and what their names say about their values.

use crate::formats::source::quote::shown;

/// A channel of an EXR.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Channel {
    /// The full name: layers and channel, with dots between them.
    pub(super) name: String,
    /// Whether the values are unsigned integers, not floats.
    pub(super) is_integer: bool,
}

/// What some channels hold together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// A primitive in one channel.
    Ids,
    /// A distance in one channel.
    Distances,
    /// A mask or a grey picture in one channel.
    Grey,
    /// Red, green, blue, and alpha if there are four.
    Colors,
    /// A vector in three channels.
    Normals,
}

/// The channels to read, by their place in the file's list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Choice {
    pub(super) meaning: Meaning,
    pub(super) channels: Vec<usize>,
}

/// The last parts of names, in small letters, as programs write them.
const DEPTH: [&str; 5] = ["z", "depth", "t", "distance", "zdepth"];
const IDS: [&str; 10] = [
    "id",
    "ids",
    "object_id",
    "objectid",
    "indexob",
    "primitive_id",
    "primitiveid",
    "prim_id",
    "primid",
    "instance_id",
];
const GREY: [&str; 11] =
    ["y", "a", "alpha", "mask", "coverage", "matte", "l", "luminance", "r", "g", "b"];
/// The layers of normals, and of normals in channels without a layer.
const NORMALS: [&str; 5] = ["n", "normal", "normals", "nn", "shading_normal"];
const XYZ: [&str; 3] = ["x", "y", "z"];
const NXYZ: [&str; 3] = ["nx", "ny", "nz"];
const RGB: [&str; 3] = ["r", "g", "b"];
const RED_GREEN_BLUE: [&str; 3] = ["red", "green", "blue"];

/// The named channels; without names, the only ones that people would expect.
pub(super) fn choose(all: &[Channel], names: &[String], normals: bool) -> Result<Choice, String> {
    let choice =
        if names.is_empty() { expected(all, normals)? } else { named(all, names, normals)? };
    let integers = choice.channels.iter().filter(|&&at| all[at].is_integer).count();
    if choice.meaning != Meaning::Ids && integers > 0 {
        return Err(format!(
            "the channels {} hold integers, which are ids alone; choose one of them, or others, with \
             --channels. {}",
            listed(&choice, all),
            list(all)
        ));
    }
    Ok(choice)
}

/// The same choice; of ids in a channel of integers also the channel with their higher halves, if there is one: its name ends
/// in `_high`, as ours do where ids have 64 bits.
pub(super) fn with_high_half(mut choice: Choice, all: &[Channel]) -> Choice {
    if let (Meaning::Ids, &[at]) = (choice.meaning, &choice.channels[..]) {
        let name = format!("{}_high", all[at].name);
        let is_half = |channel: &Channel| channel.is_integer && channel.name == name;
        let high = all.iter().position(is_half).filter(|_| all[at].is_integer);
        choice.channels.extend(high);
    }
    choice
}

/// The names of the chosen channels.
pub(super) fn listed(choice: &Choice, all: &[Channel]) -> String {
    let names: Vec<String> = choice.channels.iter().map(|&at| shown(&all[at].name)).collect();
    names.join(", ")
}

/// The channels that were named by the user.
fn named(all: &[Channel], names: &[String], normals: bool) -> Result<Choice, String> {
    let find = |name: &String| {
        let exact = all.iter().position(|channel| channel.name == *name);
        let alike = || all.iter().position(|channel| channel.name.eq_ignore_ascii_case(name));
        exact
            .or_else(alike)
            .ok_or_else(|| format!("it has no channel {}; {}", shown(name), list(all)))
    };
    let channels = names.iter().map(find).collect::<Result<Vec<usize>, String>>()?;
    let is_vector = |at: usize| {
        let last = last(&all[at].name);
        XYZ.contains(&last.as_str()) || NXYZ.contains(&last.as_str())
    };
    let meaning = match *channels {
        [at] => of_one(all, at),
        [_, _, _] if normals || channels.iter().all(|&at| is_vector(at)) => Meaning::Normals,
        [_, _, _] | [_, _, _, _] => Meaning::Colors,
        _ => {
            return Err(format!(
                "{} channels are chosen; choose one (ids, distances or a mask), three (colours or \
                 normals) or four (colours and alpha). {}",
                channels.len(),
                list(all)
            ));
        }
    };
    Ok(Choice { meaning, channels })
}

/// What one channel holds, if the user names it, or the file has no other.
fn of_one(all: &[Channel], at: usize) -> Meaning {
    if all[at].is_integer || is_id(&all[at].name) {
        Meaning::Ids
    } else if !is_depth(all, at) && GREY.contains(&last(&all[at].name).as_str()) {
        Meaning::Grey
    } else {
        Meaning::Distances
    }
}

/// The channels that viewers show, or the only ones of a known name.
fn expected(all: &[Channel], normals: bool) -> Result<Choice, String> {
    let one = |meaning, at| Choice { meaning, channels: vec![at] };
    let vectors = vectors(all);
    if normals {
        let colors = colors(all).into_iter().map(|colors| colors[..3].to_vec());
        let found: Vec<Vec<usize>> = if vectors.is_empty() { colors.collect() } else { vectors };
        return match &found[..] {
            [channels] => Ok(Choice { meaning: Meaning::Normals, channels: channels.clone() }),
            _ => Err(cannot_choose(all)),
        };
    }
    if all.len() == 1 {
        return Ok(one(of_one(all, 0), 0));
    }
    // The picture without a layer, or the only picture.
    let colors = colors(all);
    let without_layer = colors.iter().find(|colors| !all[colors[0]].name.contains('.'));
    if let Some(channels) = without_layer.or(if colors.len() == 1 { colors.first() } else { None })
    {
        return Ok(Choice { meaning: Meaning::Colors, channels: channels.clone() });
    }
    let mut found: Vec<Choice> = vectors
        .into_iter()
        .map(|channels| Choice { meaning: Meaning::Normals, channels })
        .collect();
    found.extend(colors.into_iter().map(|channels| Choice { meaning: Meaning::Colors, channels }));
    for at in 0..all.len() {
        let known = is_id(&all[at].name) || is_depth(all, at) || all[at].name == "Y";
        found.extend(known.then(|| one(of_one(all, at), at)));
    }
    match <[Choice; 1]>::try_from(found) {
        Ok([only]) => Ok(only),
        Err(_) => Err(cannot_choose(all)),
    }
}

fn cannot_choose(all: &[Channel]) -> String {
    format!("choose what to read of it with --channels NAME[,NAME...]; {}", list(all))
}

/// The first channels of the file, for a message.
fn list(all: &[Channel]) -> String {
    const MOST: usize = 16;
    let names: Vec<String> = all.iter().take(MOST).map(|channel| shown(&channel.name)).collect();
    let more = if all.len() > MOST { ", ..." } else { "" };
    format!("its channels are {}{more}", names.join(", "))
}

/// Red, green, blue, and alpha if there is one, of every layer that has them.
fn colors(all: &[Channel]) -> Vec<Vec<usize>> {
    let mut found = triples(all, &RGB, |_| true);
    found.extend(triples(all, &RED_GREEN_BLUE, |_| true));
    for colors in &mut found {
        let layer = layer(&all[colors[0]].name);
        let is_alpha = |channel: &Channel| {
            self::layer(&channel.name) == layer
                && ["a", "alpha"].contains(&last(&channel.name).as_str())
        };
        colors.extend(all.iter().position(is_alpha));
    }
    found
}

/// The three channels of every normal.
fn vectors(all: &[Channel]) -> Vec<Vec<usize>> {
    let mut found = triples(all, &XYZ, |layer| NORMALS.contains(&last(layer).as_str()));
    found.extend(triples(all, &NXYZ, |_| true));
    found
}

/// The channels with these three last parts of every layer that has all of them.
fn triples(all: &[Channel], parts: &[&str; 3], is_layer: impl Fn(&str) -> bool) -> Vec<Vec<usize>> {
    let find = |layer: &str, part: &str| {
        all.iter()
            .position(|channel| self::layer(&channel.name) == layer && last(&channel.name) == part)
    };
    let firsts = all.iter().filter(|channel| last(&channel.name) == parts[0]);
    let layers = firsts.map(|channel| layer(&channel.name)).filter(|layer| is_layer(layer));
    layers.filter_map(|layer| parts.iter().map(|part| find(layer, part)).collect()).collect()
}

/// Whether the name says that the channel holds ids: `id`, or the only letter of a layer of this name.
fn is_id(name: &str) -> bool {
    let last = last(name);
    IDS.contains(&last.as_str())
        || last.len() == 1 && IDS.contains(&self::last(layer(name)).as_str())
}

/// Whether the name says that the channel holds distances, and it is not the third part of a vector.
fn is_depth(all: &[Channel], at: usize) -> bool {
    let name = &all[at].name;
    let (layer, last) = (layer(name), last(name));
    let of_layer = last.len() == 1 && DEPTH.contains(&self::last(layer).as_str());
    let is_part = triples(all, &XYZ, |_| true).iter().any(|vector| vector.contains(&at));
    of_layer || DEPTH.contains(&last.as_str()) && !is_part
}

/// The part of a name after its last dot, in small letters.
fn last(name: &str) -> String {
    name.rsplit('.').next().unwrap_or(name).to_lowercase()
}

/// The part of a name before its last dot.
fn layer(name: &str) -> &str {
    name.rsplit_once('.').map_or("", |(layer, _)| layer)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Channels of floats, and of integers where the name begins with `#`.
    fn channels(names: &str) -> Vec<Channel> {
        let channel = |name: &str| Channel {
            name: name.trim_start_matches('#').to_owned(),
            is_integer: name.starts_with('#'),
        };
        names.split(' ').map(channel).collect()
    }

    /// The chosen names and their meaning.
    fn chosen(names: &str, of: &str, normals: bool) -> Result<String, String> {
        let all = channels(names);
        let of: Vec<String> = of.split_terminator(',').map(str::to_owned).collect();
        choose(&all, &of, normals).map(|choice| {
            format!("{:?} {}", choice.meaning, listed(&choice, &all).replace(", ", " "))
        })
    }

    #[test]
    fn what_people_expect_is_read() {
        for (names, expected) in [
            ("A B G R", "Colors R G B A"),
            ("B G R", "Colors R G B"),
            ("A B G R Z #id", "Colors R G B A"),
            ("Y", "Grey Y"),
            ("mask", "Grey mask"),
            ("Z", "Distances Z"),
            ("range", "Distances range"),
            ("#whatever", "Ids whatever"),
            ("IndexOB.X", "Ids IndexOB.X"),
            ("View.Depth.V View.Other.V", "Distances View.Depth.V"),
            ("normal.X normal.Y normal.Z", "Normals normal.X normal.Y normal.Z"),
            ("NX NY NZ", "Normals NX NY NZ"),
            (
                "View.Combined.B View.Combined.G View.Combined.R View.Depth.Z",
                "Colors View.Combined.R View.Combined.G View.Combined.B",
            ),
        ] {
            assert_eq!(chosen(names, "", false).as_deref(), Ok(expected), "{names}");
        }
        let normals = chosen("B G R normal.X normal.Y normal.Z", "", true);
        assert_eq!(normals.as_deref(), Ok("Normals normal.X normal.Y normal.Z"));
        assert_eq!(chosen("A B G R", "", true).as_deref(), Ok("Normals R G B"));
    }

    #[test]
    fn what_is_not_clear_is_asked_with_all_names() {
        let asks = "choose what to read of it with --channels NAME[,NAME...]; its channels are ";
        for names in
            ["Z #id", "x1 x2", "a.B a.G a.R b.B b.G b.R", "position.X position.Y position.Z"]
        {
            let list = names.replace('#', "").replace(' ', ", ");
            assert_eq!(chosen(names, "", false), Err(format!("{asks}{list}")));
        }
        assert!(chosen("Z #id", "", true).is_err());
    }

    #[test]
    fn names_are_taken_as_they_are() {
        let all = "A B G R Z #id normal.X normal.Y normal.Z u v w";
        for (names, expected) in [
            ("Z", "Distances Z"),
            ("z", "Distances Z"),
            ("id", "Ids id"),
            ("A", "Grey A"),
            ("u", "Distances u"),
            ("u,v,w", "Colors u v w"),
            ("R,G,B,A", "Colors R G B A"),
            ("normal.X,normal.Y,normal.Z", "Normals normal.X normal.Y normal.Z"),
        ] {
            assert_eq!(chosen(all, names, false).as_deref(), Ok(expected), "{names}");
        }
        assert_eq!(chosen(all, "u,v,w", true).as_deref(), Ok("Normals u v w"));
        let unknown = chosen("B G R", "depth", false).unwrap_err();
        assert_eq!(unknown, "it has no channel depth; its channels are B, G, R");
        assert!(
            chosen(all, "u,v", false).unwrap_err().starts_with("2 channels are chosen; choose one")
        );
        let integers = chosen(all, "R,G,id", false).unwrap_err();
        assert!(integers.starts_with("the channels R, G, id hold integers, which are ids alone"));
    }
}
