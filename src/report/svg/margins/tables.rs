//! The small tables of the page: the loads of the lock, the target, and the parameters of the scene.

use plotters::style::text_anchor::HPos;

use super::row::printed;
use super::{LINE, Page, SMALL, TEXT};
use crate::report::margins::{STRONGEST, words};
use crate::report::number::{speed as speed_text, time, with_unit};
use crate::report::svg::LEFT;
use crate::report::svg::paper::{Drawn, typed, write_at, write_from};
use crate::report::symbols::{in_print, symbol};
use rubscope_solver::scene::keys::{Allowed, KEYS};
use rubscope_solver::scene::{Scene, SolverKind, Value};
use rubscope_solver::study::margins::{Limit, Margins};

/// Columns of the loads: words, right end of the value, way it acts, what moves it.
const LOADS: [i32; 4] = [76, 440, 450, 520];
/// The loads of the locked motion.
pub(super) fn loads(margins: &Margins, page: &mut Page<'_, '_>) -> Drawn<()> {
    let loads = margins.limits.iter().filter(|limit| limit.is_load());
    let (with, without): (Vec<&Limit>, Vec<&Limit>) = loads.partition(|row| row.value.is_some());
    page.rule()?;
    let speed = printed(&speed_text(margins.scene.operation.speed_rad_s));
    let none = match without.first().and_then(|row| row.note.as_ref()) {
        Some(note) if with.is_empty() => format!(" none: {note}"),
        _ => String::new(),
    };
    let [what, value, side, moves] = LOADS;
    page.lines(&format!("The locked motion at {speed}:{none}"), TEXT, 20)?;
    for row in with {
        let Some(load) = row.value else { continue };
        let (area, y) = (page.area, page.y);
        write_at(area, row.name.symbol(), (LEFT, y), SMALL)?;
        write_at(area, row.name.what(), (what, y), SMALL)?;
        let load = printed(&words::value(load, 6, row.quantity));
        write_from(area, &load, (value, y), SMALL, HPos::Right)?;
        write_at(area, &row.way(), (side, y), SMALL)?;
        for ((path, by), x) in
            row.sensitivities.strongest(STRONGEST).iter().zip((moves..).step_by(102))
        {
            let told = format!("{} {}", symbol(path), words::change(*by));
            write_at(area, &in_print(&told), (x, y), SMALL)?;
        }
        page.y += LINE + 2;
    }
    Ok(())
}

/// The parameter that puts a limit where it is wanted.
pub(super) fn target(margins: &Margins, page: &mut Page<'_, '_>) -> Drawn<()> {
    let Some(found) = &margins.target else { return Ok(()) };
    page.rule()?;
    page.lines(&typed(&words::target(found, margins)), TEXT, 19)?;
    match words::check(found, &margins.scene) {
        Some(command) => page.lines(&typed(&format!("Check it: {command}")), SMALL, LINE),
        None => Ok(()),
    }
}

/// Every parameter of a scene, but what it has at zero of its start and its ramp, in
/// lines of at most so many letters.
pub(super) fn parameters(scene: &Scene, most: usize) -> Vec<String> {
    let mut told: Vec<String> = Vec::new();
    for key in KEYS {
        let number = matches!(key.allowed, Allowed::Real { .. } | Allowed::Whole { .. });
        let own =
            ["solver.", "excitation.", "view."].iter().any(|table| key.path.starts_with(table));
        if !number || own {
            continue;
        }
        let value = match (key.get)(scene) {
            Value::Real(0.0) if key.path.starts_with("initial.") || key.path.contains("ramp") => {
                continue;
            }
            Value::Real(x) => with_unit(x, 6, if key.unit == "-" { "" } else { key.unit }),
            other => other.to_string(),
        };
        told.push(format!("{} = {}", in_print(&symbol(key.path)), printed(&value)));
    }
    if scene.excitation.amplitude_nm != 0.0 {
        let torque = with_unit(scene.excitation.amplitude_nm, 6, "N m");
        told.push(format!("engine order {} with {torque}", scene.excitation.order));
    }
    let solver = &scene.solver;
    told.push(format!("{} solver, {} law, {} model", solver.kind, solver.contact, solver.model));
    if solver.kind == SolverKind::Explicit {
        told.push(format!("h = {}", printed(&time(solver.step_s))));
    }
    told.push(format!("runs of {}", printed(&time(solver.end_s))));
    let mut lines: Vec<String> = Vec::new();
    for one in told {
        match lines.last_mut() {
            // Nothing is broken within a value.
            Some(line) if line.chars().count() + one.chars().count() + 3 <= most => {
                line.push_str(", ");
                line.push_str(&one);
            }
            _ => lines.push(one),
        }
    }
    let last = lines.len().saturating_sub(1);
    lines.iter_mut().take(last).for_each(|line| line.push(','));
    lines
}
