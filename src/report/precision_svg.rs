//! The work-precision chart as SVG: log error against log time.

use plotters::prelude::*;

use super::precision::{place, series};
use crate::scene::{ContactLaw, ModelSize, SolverKind};
use crate::study::precision::{Precision, Way};

/// Colour by solver and law; the model size is told by the marker's size.
fn style(way: &Way) -> (RGBColor, i32) {
    let colour = match (way.solver, way.contact) {
        (SolverKind::Event, _) => RGBColor(0, 114, 178),
        (SolverKind::Explicit, ContactLaw::Unilateral) => RGBColor(213, 94, 0),
        (SolverKind::Explicit, ContactLaw::Bilateral) => RGBColor(120, 120, 120),
    };
    let size = match way.model {
        ModelSize::Rigid => 3,
        ModelSize::Modal => 5,
        ModelSize::Full => 7,
    };
    (colour, size)
}

/// Draws the chart.
///
/// # Errors
/// What the drawing backend says, in words; nothing to compare.
pub fn draw(report: &Precision) -> Result<String, String> {
    let placed: Vec<(Way, (f64, f64))> =
        report.rows.iter().filter_map(|row| Some((row.way, place(row)?))).collect();
    if placed.is_empty() {
        return Err("on a sensitive scene there are no errors to draw".to_string());
    }
    let mut svg = String::new();
    draw_rows(&mut svg, &report.scene.title, &placed).map_err(|error| error.to_string())?;
    Ok(svg)
}

/// Label of a whole power of ten; none between.
fn decade(exponent: &f64) -> String {
    if (exponent - exponent.round()).abs() < 1e-9 {
        format!("1e{exponent:.0}")
    } else {
        String::new()
    }
}

fn draw_rows(
    svg: &mut String,
    title: &str,
    placed: &[(Way, (f64, f64))],
) -> Result<(), Box<dyn std::error::Error>> {
    let words = |error: &dyn std::fmt::Display| error.to_string();
    let bound = |value: fn(&(f64, f64)) -> f64| {
        let values = || placed.iter().map(|(_, at)| value(at));
        let low = values().fold(f64::INFINITY, f64::min).floor();
        low..values().fold(f64::NEG_INFINITY, f64::max).ceil().max(low + 1.0)
    };
    let area = SVGBackend::with_string(svg, (900, 600)).into_drawing_area();
    area.fill(&WHITE).map_err(|error| words(&error))?;
    let mut chart = ChartBuilder::on(&area)
        .caption(format!("Speed against error: {title}"), ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(48)
        .y_label_area_size(64)
        .build_cartesian_2d(bound(|at| at.0), bound(|at| at.1))
        .map_err(|error| words(&error))?;
    chart
        .configure_mesh()
        .x_desc("wall time [s]")
        .y_desc("error at the end [of the clearance]")
        .x_label_formatter(&decade)
        .y_label_formatter(&decade)
        .draw()
        .map_err(|error| words(&error))?;
    let mut names: Vec<String> = placed.iter().map(|(way, _)| series(way)).collect();
    names.dedup();
    for name in names {
        let of_series = || placed.iter().filter(|(way, _)| series(way) == name);
        let Some((way, _)) = of_series().next() else { continue };
        let (colour, size) = style(way);
        chart
            .draw_series(LineSeries::new(of_series().map(|(_, at)| *at), colour.mix(0.5)))
            .map_err(|error| words(&error))?;
        chart
            .draw_series(of_series().map(|(_, at)| Circle::new(*at, size, colour.filled())))
            .map_err(|error| words(&error))?
            .label(name)
            .legend(move |at| Circle::new(at, size, colour.filled()));
    }
    chart
        .configure_series_labels()
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK)
        .draw()
        .map_err(|error| words(&error))?;
    area.present().map_err(|error| words(&error))?;
    Ok(())
}
