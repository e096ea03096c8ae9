//! View 3: the multipliers of the locked motion against speed, the speeds
//! where things change, the present speed, and what the time solver finds.

use ratatui::{buffer::Buffer, layout::Rect};

use super::charts::{entry, title};
use crate::motion::Touching;
use crate::tui::app::{App, View};
use crate::tui::axis::nice_step;
use crate::tui::plot::{Axis, Plot};
use crate::tui::theme::Role;

/// Draws the view.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    let skin = &app.skin;
    let quiet = skin.style(Role::Quiet);
    let damped = app.machine.casing_damping > 0.0;
    let point = skin.either('◆', '@');
    let mut legend = vec![entry(skin, &skin.first(), if damped { "λ_a" } else { "λ" })];
    if damped {
        legend.push(entry(skin, &skin.second(), "λ_b"));
    }
    legend.push((format!("{point} running"), skin.style(Role::Contact)));
    legend.push(("N over rad/s".into(), quiet));
    legend.push(("below 0 pushes".into(), quiet));
    let inside = title(app, buffer, area, View::Locked, "locked λ(Ω)", &legend);
    let fastest = speed_range(app);
    let ends = [0.0, fastest].map(|speed| app.machine.locked_multipliers(speed));
    let (Some(slow), Some(fast)) = (ends[0], ends[1]) else {
        let no = "no corner between two blade groups: this wave never locks";
        super::print(buffer, inside, 1, no, quiet);
        return;
    };
    let points = time_points(app);
    let all = slow.iter().chain(&fast).chain(points.iter());
    let (low, high) = all.fold((0.0_f64, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
    let step = nice_step(high - low, 6).unwrap_or(1.0);
    let y = Axis::scaled((low / step).floor() * step, (high / step).ceil() * step);
    let Some(mut plot) = Plot::new(buffer, inside, Axis::plain(0.0, fastest), y, skin) else {
        return;
    };
    let marks = thresholds(app);
    plot.level(0.0, skin.either('┈', '.'), quiet);
    for (speed, _) in &marks {
        plot.upright(*speed, skin.either('┊', ':'), quiet);
    }
    let speed = app.speed().abs();
    plot.upright(speed, skin.either('│', '|'), skin.style(Role::Focus));
    let speeds = plot.column_values();
    for (place, pen) in [skin.first(), skin.second()].iter().enumerate().rev() {
        if place == 0 || damped {
            let curve = |speed: &f64| {
                let pair = app.machine.locked_multipliers(*speed)?;
                pair.get(place).map(|lambda| (*speed, *lambda))
            };
            plot.curve(speeds.iter().filter_map(curve), pen);
        }
    }
    plot.ink();
    for force in points {
        plot.point(speed, force, point, skin.style(Role::Contact));
    }
    names(&mut plot, &marks, app);
}

/// Names of the thresholds in the top row, one beside the other.
fn names(plot: &mut Plot, marks: &[(f64, &str)], app: &App) {
    let mut free = plot.inner.x;
    for (speed, name) in marks {
        let name = app.skin.spell(name);
        let wide = u16::try_from(name.chars().count()).unwrap_or(u16::MAX);
        for row in plot.inner.y..plot.inner.y.saturating_add(3).min(plot.inner.bottom()) {
            if let Some(column) = plot.column(*speed)
                && (column >= free || row > plot.inner.y)
            {
                plot.note(*speed, row, &name, app.skin.style(Role::Text));
                free = column.saturating_add(wide + 1);
                break;
            }
        }
    }
}

/// From zero to a round speed beyond everything of interest \[rad/s\].
fn speed_range(app: &App) -> f64 {
    let machine = &app.machine;
    let of_interest = [
        machine.lock_speed(),
        machine.dangerous_speed(),
        Some(app.speed().abs()),
        Some(app.scene.operation.speed_rad_s.abs()),
    ];
    let most = of_interest.into_iter().flatten().filter(|s| s.is_finite()).fold(1.0, f64::max);
    let step = nice_step(most * 1.15, 10).unwrap_or(most);
    (most * 1.05 / step).ceil() * step
}

/// The speeds where things change, slowest first.
fn thresholds(app: &App) -> Vec<(f64, &'static str)> {
    let machine = &app.machine;
    let mut marks: Vec<(f64, &'static str)> = [
        (machine.critical_speed(), "Ω_c"),
        (machine.lock_speed(), "Ω_lock"),
        (machine.dangerous_speed(), "coincidence"),
    ]
    .into_iter()
    .filter_map(|(speed, name)| Some((speed?, name)))
    .collect();
    if machine.casing_damping == 0.0 {
        // Without damping the two thresholds are one.
        marks.retain(|(_, name)| *name != "Ω_lock");
    }
    marks.sort_by(|a, b| a.0.total_cmp(&b.0));
    marks
}

/// Mean multipliers of the time solver, while something touches.
fn time_points(app: &App) -> Vec<f64> {
    let Some(moment) = &app.moment else { return Vec::new() };
    if moment.touching == Touching::Nothing {
        return Vec::new();
    }
    moment.multipliers.iter().map(|(_, force)| *force).filter(|force| force.is_finite()).collect()
}
