//! View 1: the casing coordinates over a page of time; the blade coordinates below, if it has the
//! full screen; and the run under the other contact law or a pinned run, for comparison.

use ratatui::buffer::Buffer;

use super::chart::{Chart, Curve};
use super::panel::{Lines, ViewArea, ViewPanel, dots, entry, message, paragraph};
use crate::sheet::Sheet;
use crate::sheet::line::clean;
use crate::sheet::table::{Table, TableCell};
use crate::tui::app::{App, Cursor};
use crate::tui::appearance::Appearance;
use crate::tui::axis::{AutoRange, ChartAxis, instant, readable};
use crate::tui::engine::{FullRun, Moment};
use crate::tui::film::other_law;
use crate::tui::history::{self, Bin, Channel};
use crate::tui::plot::{Plot, contact};
use crate::tui::raster::Pen;
use crate::tui::text::columns;
use crate::tui::theme::Role;
use crate::tui::trace::Happening;
use rubscope_solver::motion::ActiveSet;
use rubscope_solver::scene::ModelSize;
use rubscope_solver::study::figures::{Figure, Panel, Quantity, Series, Style};

/// Largest number of changes of contact per page that are considered for labels.
const MOST_NAMES: usize = 500;
/// Width from which two contact laws are side by side.
const SIDE_BY_SIDE_FROM: u16 = 90;

/// The view of casing and blade coordinates over time.
pub struct ResponseView;

impl ViewPanel for ResponseView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let casing = Page::casing("response".into(), app);
        if app.run.compare {
            both_laws(app, buffer, at);
        } else if let (above, Some(below)) = at.pair(40)
            && app.layout.full_screen
            && bends(app)
        {
            page(app, buffer, above.above(below.area), &casing);
            let blades = Page {
                name: "response, blades".into(),
                names: ["α_c", "α_s"],
                channels: [Channel::AlphaC, Channel::AlphaS],
                range: app.run.ranges.blades,
                unit: "rad",
                ..casing
            };
            page(app, buffer, below, &blades);
        } else {
            page(app, buffer, at, &casing);
        }
    }

    fn here(&self, app: &App) -> Cursor {
        Cursor { across: app.part_of_page(), up: 0.5 }
    }

    /// Returns the page up to the current time.
    fn sheet<'a>(&self, app: &'a App) -> Option<Sheet<'a>> {
        let bins = app.past_and_future(app.record()).0;
        let mut sheet = Sheet::new("run", 1, app.view_command(), &app.scene);
        sheet.filed(None, table(bins));
        sheet.picture(move || figure(app, bins));
        Some(sheet)
    }
}

/// Returns the minimum and maximum of every channel in each bin.
fn table(bins: &[Bin]) -> Table<'_> {
    let channels = [
        (Channel::UC, "u_c_m"),
        (Channel::US, "u_s_m"),
        (Channel::AlphaC, "alpha_c_rad"),
        (Channel::AlphaS, "alpha_s_rad"),
        (Channel::Gap, "smallest_gap_m"),
        (Channel::Push, "push_n"),
        (Channel::X, "z_real_m"),
        (Channel::Y, "z_imaginary_m"),
    ];
    let of_channels =
        channels.iter().flat_map(|(_, name)| [format!("{name}_least"), format!("{name}_greatest")]);
    let times = ["from_s", "to_s"].map(String::from).into_iter();
    let headings: Vec<_> = times.chain(of_channels).chain(["contact".into()]).collect();
    Table::new(headings, bins.len(), move |place| {
        let bin = &bins[place];
        let spans = channels.iter().flat_map(|(channel, _)| <[f64; 2]>::from(bin.span(*channel)));
        let contact = u64::from(bin.contact.is_some());
        let numbers = [bin.from, bin.to].into_iter().chain(spans).map(TableCell::from);
        numbers.chain([contact.into()]).collect()
    })
}

/// Draws the bins: each is a line between its minimum and its maximum, up or down as the bins
/// around it go.
fn figure(app: &App, bins: &[Bin]) -> Figure {
    let series = |(number, (label, channel)): (usize, &(&str, Channel))| {
        let ends = |(place, bin): (usize, &Bin)| {
            let (least, greatest) = bin.span(*channel);
            let near = |at: usize| bins.get(at).unwrap_or(bin).middle(*channel);
            let falls = near(place + 1) < near(place.saturating_sub(1));
            let [first, last] = if falls { [greatest, least] } else { [least, greatest] };
            [(bin.from, first), (bin.to, last)]
        };
        Series::new(*label, Style::Line(number), bins.iter().enumerate().flat_map(ends))
    };
    let panel = |label: &'static str, channels: &[(&str, Channel)]| {
        let series = channels.iter().enumerate().map(series).collect();
        Panel::new("", Quantity::TIME, Quantity::new("", label, 1.0), series)
    };
    let panels = vec![
        panel("casing [m]", &[("u_c", Channel::UC), ("u_s", Channel::US)]),
        panel("blades [rad]", &[("α_c", Channel::AlphaC), ("α_s", Channel::AlphaS)]),
        panel("smallest gap [m]", &[("gap", Channel::Gap)]),
    ];
    Figure::new(app.scene.title.clone(), "", panels)
}

/// Returns whether blades bend; in the rigid model their coordinates are only round-off.
fn bends(app: &App) -> bool {
    app.scene.solver.model != ModelSize::Rigid
}

/// Content of one chart over the page.
struct Page<'a> {
    name: String,
    /// Labels of the two curves.
    names: [&'static str; 2],
    channels: [Channel; 2],
    range: AutoRange,
    unit: &'static str,
    /// The bins of the page.
    record: &'a [Bin],
    /// The run to its end; `None` until it is complete.
    forecast: Option<&'a FullRun>,
    /// Whether this is the scene's own law, with cursor, labels and pinned run.
    own: bool,
}

impl<'a> Page<'a> {
    fn casing(name: String, app: &'a App) -> Self {
        Self {
            name,
            names: ["u_c", "u_s"],
            channels: [Channel::UC, Channel::US],
            range: app.run.ranges.casing,
            unit: "m",
            record: app.record(),
            forecast: app.full_run(),
            own: true,
        }
    }
}

/// Draws the runs under both contact laws, side by side or one above the other.
fn both_laws(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let [first, second] =
        if at.area.width >= SIDE_BY_SIDE_FROM { at.columns() } else { at.rows(50) };
    let law = app.scene.solver.contact;
    let own = Page::casing(format!("{}: {}", law, app.verdict_word()), app);
    let comparison = app.results().comparison.as_deref();
    let word = comparison
        .map_or("...".to_string(), |outcome| outcome.facts.verdict.as_ref().to_uppercase());
    let theirs = Page {
        record: app.recorded(app.results().comparison_page.as_deref()),
        forecast: comparison,
        own: false,
        ..Page::casing(format!("{}: {word}", law.other()), app)
    };
    if let Err(why) = other_law(&app.scene) {
        page(app, buffer, first, &own);
        let why = clean(&why.to_string());
        return message(app, buffer, second, (&theirs.name, &[]), (&why, Role::Trouble));
    }
    page(app, buffer, first.above(second.area), &own);
    page(app, buffer, second, &theirs);
}

fn page(app: &App, buffer: &mut Buffer, at: ViewArea, what: &Page) {
    let look = &app.appearance;
    let (from, to) = app.page();
    let (x, y) = (ChartAxis::scaled(from, to), ChartAxis::scaled(what.range.low, what.range.high));
    let pens = [look.first(), look.second()];
    let mark = contact(look);
    let lines = if what.own { failed(app, at) } else { Lines::new() };
    let mut chart = Chart::new(&what.name, x, y.evened(at.below(lines.len()), look));
    chart.lines = lines;
    // Of two laws each keeps its name.
    let kept = if app.run.compare { columns(&what.name) } else { 0 };
    let read = reading(app, what, usize::from(at.area.width).saturating_sub(kept));
    match read {
        Some(read) if app.run.compare => chart.legend.push((read, look.style(Role::Focus))),
        read => chart.reading = read,
    }
    let names = pens.iter().zip(what.names);
    chart.legend.extend(names.map(|(pen, name)| entry(look, pen, name)));
    let unit = format!("{}{} by {}s", y.scale.prefix, what.unit, x.scale.prefix);
    chart.legend.push((unit, look.style(Role::Quiet)));
    if let Some(baseline) = app.run.baseline.as_ref().filter(|_| what.own) {
        let name = format!("{} pinned: {}", what.names[0], baseline.what(app));
        chart.legend.push(entry(look, &pinned(look), &name));
    }
    if what.forecast.is_some() {
        chart.legend.push(dots(look, "to come"));
    }
    chart.legend.push((format!("{mark} contact"), look.style(Role::Contact)));
    chart.levels = vec![(0.0, "", Role::Quiet)];
    chart.levels.extend(clearance_levels(app, what));
    chart.read = app.reading.at_s;
    let (past, _) = app.past_and_future(what.record);
    let spans = |record, channel| {
        Curve::Spans(Box::new(move |count| history::columns(record, channel, (from, to), count)))
    };
    chart.curves =
        what.channels.iter().zip(pens).map(|(at, pen)| (pen, spans(past, *at))).collect();
    chart.curves.extend(ghost(app, what));
    if app.run.baseline.is_some() && what.own {
        let record = app.recorded(app.results().pinned_page.as_deref());
        chart.curves.push((pinned(look), spans(record, what.channels[0])));
    }
    let Some(mut plot) = chart.draw(app, buffer, at) else { return };
    let cells = usize::from(plot.inner.width);
    // Contact marks go on the time axis if there is one, so that they cover no data.
    let row = plot.axis_row().unwrap_or(plot.inner.bottom() - 1);
    let contacts = history::contacts(past, (from, to), cells);
    for (column, _) in (plot.inner.x..).zip(contacts).filter(|(_, touched)| *touched) {
        plot.text(column, row, &mark.to_string(), look.style(Role::Contact));
    }
    names_of_marks(app, &mut plot, what);
}

/// Returns the pen of a pinned run.
fn pinned(look: &Appearance) -> Pen {
    Pen { sign: '+', ..look.quiet() }
}

/// Returns the solver's message, which is above the chart if the motion failed.
fn failed(app: &App, at: ViewArea) -> Lines {
    let told = |failure: &String| paragraph(app, failure, at.area, Role::Trouble);
    let mut lines = app.failure().map_or(Lines::new(), told);
    lines.truncate(usize::from(at.below(0).height / 3));
    lines
}

/// Returns the clearance levels \[m\] with their labels, for scenes beyond the paper, where the
/// casing can pass them; empty otherwise, and for the chart of the blades.
fn clearance_levels(app: &App, what: &Page) -> Vec<(f64, &'static str, Role)> {
    if !app.scene.goes_beyond() || what.unit != "m" {
        return Vec::new();
    }
    let clearance = app.machine.clearance().abs();
    let names = if app.is_pressed() { ["|g0|", "-|g0|"] } else { ["g0", "-g0"] };
    let levels = [clearance, -clearance].into_iter().zip(names);
    levels.map(|(level, name)| (level, name, Role::Quiet)).collect()
}

/// Returns the values at the cursor, recomputed for that time; under the other law the middle of
/// the bin there. The time is omitted if it does not fit. `None` without a cursor, and until the
/// values are known.
fn reading(app: &App, what: &Page, width: usize) -> Option<String> {
    app.reading.at_s?;
    let values = |moment: &Moment| match what.unit {
        "rad" => moment.state.alpha,
        _ => moment.state.u,
    };
    if !what.own {
        // The motion under the other law is not recomputed; use the middle of its bin.
        let t = app.reading.at_s?;
        let bin = history::bin_at(what.record, t)?;
        let [first, second] = what.channels.map(|channel| readable(bin.middle(channel), what.unit));
        return Some(format!("near {}: {first}, {second}", readable(t, "s")));
    }
    let moment = app.shown()?;
    let named = what.names.iter().zip(values(moment));
    let named: Vec<String> =
        named.map(|(name, value)| format!("{name} {}", readable(value, what.unit))).collect();
    let values = named.join(", ");
    let whole = format!("at {}: {values}", instant(moment.state.t_s));
    // Rule, digit and gaps of the title take seven columns.
    Some(if columns(&whole) + 7 > width { values } else { whole })
}

/// Returns the future of the run as dots. Their positions are fixed on the page, so that they do not
/// move as the motion advances.
fn ghost<'a>(app: &App, what: &Page<'a>) -> Vec<(Pen, Curve<'a>)> {
    let (look, ahead, record) = (&app.appearance, app.known_s(), what.record);
    let machine = &app.machine;
    let fastest = machine.omega_c.max(machine.omega_bd).max(machine.nu(app.speed().abs()));
    // If the wave turns within a bin, draw its envelope.
    let length = record.iter().map(|bin| bin.to - bin.from).fold(0.0, f64::max);
    let parts: &[f64] = if length * fastest > 1.0 { &[1.0, 0.0] } else { &[0.5] };
    let mut dots = Vec::new();
    for (channel, pen) in what.channels.into_iter().zip([look.first(), look.second()]) {
        let sparse = if pen.dashed { 2.0 } else { 1.0 };
        for &part in parts {
            let points = record.iter().map(move |bin| {
                let (low, high) = bin.span(channel);
                (0.5 * (bin.from + bin.to), low + part * (high - low))
            });
            let pen = Pen { sign: '.', dashed: false, ..pen };
            dots.push((pen, Curve::Dots(Box::new(points), ahead, sparse)));
        }
    }
    dots
}

/// Prints the blades of the first contacts of the page on the time axis.
fn names_of_marks(app: &App, plot: &mut Plot, what: &Page) {
    let Some(run) = what.forecast.filter(|_| what.own && what.unit == "m") else { return };
    let (from, to) = app.page();
    let look = &app.appearance;
    let sign = look.either('▲', '^');
    let first = run.marks.partition_point(|mark| mark.t_s < from);
    let on_page = || run.marks.iter().skip(first).take_while(|mark| mark.t_s <= to);
    // Corners are labelled first: they last, while impacts are many.
    for corners in [true, false] {
        for mark in on_page().take(MOST_NAMES) {
            let touching = match mark.what {
                Happening::Contact(_, touching) => touching,
                Happening::Impact(side) => ActiveSet::Side(side),
                Happening::Release(_) => continue,
            };
            if touching.sides().next().is_none()
                || matches!(touching, ActiveSet::Corner(..)) != corners
            {
                continue;
            }
            let name = app.numbers_of(touching.sides()).replace(' ', "");
            let text = format!("{sign}{name}");
            plot.axis_note(mark.t_s, &text, look.style(Role::Contact), look);
        }
    }
}
