//! `bothways rules`: the rules of ordinary renderers, what each gets wrong, and a scene that shows it.

use super::failure::Failure;
use super::terminal;
use anstyle::Style;
use bothways::orders::{Order, Rule};
use clap::Args;
use serde::Serialize;
use std::process::ExitCode;

pub(super) const EXAMPLES: &str = "\
Without rules both orders are exact. With a rule on one side, the difference is what that sort of renderer gets
wrong; with a rule on both, how far two such renderers are apart.

Examples:
  bothways rules                                     list them
  bothways ties --object-rules inclusive             a fill rule against the exact answer
  bothways bunny.obj --object-rules snapped:8 --image-rules watertight
                                                     an ordinary rasterizer against an ordinary ray tracer";

/// How to list.
#[derive(Debug, Args)]
pub(super) struct RulesArgs {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Lists all rules.
pub(super) fn run(args: &RulesArgs) -> Result<ExitCode, Failure> {
    let list = List { object_order: entries(Order::Object), image_order: entries(Order::Image) };
    let text = if args.json { terminal::json(&list)? } else { list.text() };
    terminal::print(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// The output of `--json`, in this order.
#[derive(Debug, Serialize)]
struct List {
    object_order: Vec<Entry>,
    image_order: Vec<Entry>,
}

/// One rule.
#[derive(Debug, Serialize)]
struct Entry {
    rule: &'static str,
    what: &'static str,
    reproduces: &'static str,
    /// The built-in scene that shows it.
    scene: &'static str,
    /// The command that shows it.
    command: String,
}

fn entries(order: Order) -> Vec<Entry> {
    let of_order = |rule: &Rule| rule.order() == order;
    Rule::examples().into_iter().filter(of_order).map(Entry::new).collect()
}

impl Entry {
    fn new(rule: Rule) -> Entry {
        let (about, scene) = (rule.about(), rule.scene());
        Entry {
            rule: about.form,
            what: about.what,
            reproduces: about.reproduces,
            scene,
            command: format!("bothways {scene} {} {rule}", rule.option()),
        }
    }
}

impl List {
    fn text(&self) -> String {
        let section = |order: Order, option: &str, entries: &[Entry]| {
            let bold = Style::new().bold();
            let (name, common) = (order.name(), order.common_name());
            let mut text = format!("{bold}{name}{bold:#} ({common}): {option} RULE\n");
            for entry in entries {
                text += &entry.text();
            }
            text
        };
        [
            section(Order::Object, "--object-rules", &self.object_order),
            section(Order::Image, "--image-rules", &self.image_order),
        ]
        .join("\n")
    }
}

impl Entry {
    fn text(&self) -> String {
        let bold = Style::new().bold();
        let dimmed = Style::new().dimmed();
        let Entry { rule, what, reproduces, command, .. } = self;
        format!(
            "\n  {bold}{rule}{bold:#}\n    {what}\n    gives: {reproduces}\n    see:   {dimmed}{command}{dimmed:#}\n"
        )
    }
}
