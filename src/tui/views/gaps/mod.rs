//! View 2: the gap of every blade at one time, above the zero line of the casing. Blades in contact
//! are marked and numbered.

use ratatui::buffer::Buffer;

use crate::sheet::Sheet;
use crate::sheet::table::Table;
use crate::tui::app::{App, Cursor};
use crate::tui::axis::{ChartAxis, instant};
use crate::tui::plot::Plot;
use crate::tui::raster::Pen;
use crate::tui::theme::Role;
use crate::tui::views::ViewId;
use crate::tui::views::chart::{Chart, Curve};
use crate::tui::views::panel::{ViewArea, ViewPanel};
use rubscope_solver::study::figures::{Figure, Panel, Quantity, Series, Style};

/// The view of the gap of every blade.
pub struct GapsView;

impl ViewPanel for GapsView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let look = &app.appearance;
        let quiet = look.style(Role::Quiet);
        let contact = look.style(Role::Contact);
        let range = app.run.ranges.gaps;
        let y = ChartAxis::scaled(range.low, range.high);
        let count = app.machine.polygon.blades;
        let x = ChartAxis::plain(0.5, f64::from(count) + 0.5);
        let active_set = app.touching_blades();
        let mark = look.either('▲', '^');
        let style = if active_set.is_empty() { quiet } else { contact };
        let mut chart = Chart::new("gaps", x, y.evened(at.below(0), look));
        chart.legend = vec![
            (format!("{}m by blade", y.scale.prefix), quiet),
            (format!("{mark} {}", app.state_now()), style),
        ];
        chart.reading = reading(app);
        // With a lining the level of the clearance can be below zero, so it needs a label.
        let name = if app.has_lining() { "g0" } else { "" };
        chart.levels = vec![(0.0, "", Role::Text), (app.machine.clearance(), name, Role::Quiet)];
        chart.read = read_blade(app).map(|blade| f64::from(blade + 1));
        let moment = app.shown();
        let gaps: &[f64] = moment.map_or(&[], |moment| &moment.gaps);
        let known = || (1..=count).map(f64::from).zip(gaps.iter().copied());
        // The labels of the axis take up to six columns.
        let room = u32::from(at.area.width.saturating_sub(6));
        // There are no values between blades; the line only joins the points.
        if app.is_still() || count > room {
            let pen = Pen { dashed: false, ..look.quiet() };
            chart.curves.push((pen, Curve::Line(Box::new(known()))));
        }
        let shown = |gap: f64| gap.clamp(range.low, range.high);
        if count <= room {
            let sign = look.either(if 2 * count <= room { '●' } else { '•' }, 'o');
            let first = look.style(Role::First);
            chart.points = known().map(|(blade, gap)| (blade, shown(gap), sign, first)).collect();
        }
        for blade in active_set.iter().filter(|_| moment.is_some()) {
            // Contact with a rigid casing is at zero, with a lining at some depth.
            let gap = gaps.get(blade.saturating_sub(1) as usize).filter(|_| app.has_lining());
            chart.points.push((f64::from(*blade), shown(*gap.unwrap_or(&0.0)), mark, contact));
        }
        let Some(mut plot) = chart.draw(app, buffer, at) else { return };
        if moment.is_some() {
            label(&mut plot, &active_set, app);
        }
    }

    fn grid(&self, app: &App) -> [u32; 2] {
        [app.machine.polygon.blades, 0]
    }

    fn here(&self, _: &App) -> Cursor {
        Cursor { across: 0.0, up: 1.0 }
    }

    fn sheet<'a>(&self, app: &'a App) -> Option<Sheet<'a>> {
        let now = app.shown_now()?;
        let mut sheet = Sheet::new("run", 1, app.view_command(), &app.scene);
        let headings = ["t_s", "blade", "gap_m"];
        sheet.filed(
            None,
            Table::new(headings, now.gaps.len(), move |place| {
                vec![now.state.t_s.into(), (place as u64 + 1).into(), now.gaps[place].into()]
            }),
        );
        sheet.picture(move || {
            let gaps = (1..).map(f64::from).zip(now.gaps.iter().copied());
            let (x, y) =
                (Quantity::whole("blade", "blade"), Quantity::new("gap_m", "gap [m]", 1.0));
            let panel = Panel::new("", x, y, vec![Series::new("gap", Style::Discs(0, 4), gaps)]);
            let note = format!("at {}", instant(now.state.t_s));
            Figure::new(app.scene.title.clone(), note, vec![panel])
        });
        Some(sheet)
    }
}

/// Returns the index of the blade under the cursor, from 0; `None` without a cursor in this view.
fn read_blade(app: &App) -> Option<u32> {
    app.cell_in(ViewId::Gaps).map(|[blade, _]| blade)
}

/// Describes the blade under the cursor: number, gap, and the time if the cursor has one. `None`
/// with neither, and before the first snapshot.
fn reading(app: &App) -> Option<String> {
    let moment = app.shown()?;
    let blade = read_blade(app).and_then(|blade| {
        let gap = moment.gaps.get(blade as usize)?;
        Some(format!("blade {}: {}", blade + 1, app.gap_words(*gap)))
    });
    let at = app.reading.at_s.map(|_| format!("at {}", instant(moment.state.t_s)));
    let parts: Vec<String> = blade.into_iter().chain(at).collect();
    (!parts.is_empty()).then(|| parts.join(" "))
}

/// Prints the numbers of the touching blades on the axis, or below the zero line where that is
/// free.
fn label(plot: &mut Plot, active_set: &[u32], app: &App) {
    if app.has_lining() && 2 * active_set.len() > app.machine.polygon.blades as usize {
        return;
    }
    let (look, below) = (&app.appearance, plot.row(0.0).map(|row| row + 1));
    let style = look.style(Role::Contact);
    for blade in active_set.iter().take(16) {
        let (at, name) = (f64::from(*blade), blade.to_string());
        if !plot.axis_note(at, &name, style, look)
            && let Some(row) = below
        {
            plot.free_note(at, row, &name, style);
        }
    }
}
