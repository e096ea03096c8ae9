//! The work-precision chart as SVG: log error against log time.

use plotters::prelude::*;

use super::precision::{Place, decades, place, series};
use crate::scene::{ContactLaw, ModelSize, SolverKind};
use crate::study::precision::{Precision, Row, Way};

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
    let placed: Vec<(&Row, Place)> =
        report.rows.iter().filter_map(|row| Some((row, place(row)?))).collect();
    let times = decades(placed.iter().map(|(_, at)| at.time));
    let errors = decades(placed.iter().filter_map(|(_, at)| at.error));
    let (Some(times), Some(errors)) = (times, errors) else {
        return Err(match (placed.is_empty(), report.reference.sensitive) {
            (false, _) => "every error is 0: a logarithmic axis has no place for it".to_string(),
            (_, true) => "on a sensitive scene there are no errors to draw".to_string(),
            _ => "every run or the reference failed: there are no errors to draw".to_string(),
        });
    };
    let mut svg = String::new();
    draw_rows(&mut svg, &report.scene.title, &placed, times, errors)
        .map_err(|error| error.to_string())?;
    Ok(svg)
}

/// Name of a series, with a word on a law that is not the reference's.
fn name(row: &Row) -> String {
    let law = if row.other_law { ", other law" } else { "" };
    format!("{}{law}", series(&row.way))
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
    placed: &[(&Row, Place)],
    (left, right): (f64, f64),
    (bottom, top): (f64, f64),
) -> Result<(), Box<dyn std::error::Error>> {
    let words = |error: &dyn std::fmt::Display| error.to_string();
    let area = SVGBackend::with_string(svg, (900, 600)).into_drawing_area();
    area.fill(&WHITE).map_err(|error| words(&error))?;
    let mut chart = ChartBuilder::on(&area)
        .caption(format!("Speed against error: {title}"), ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(48)
        .y_label_area_size(64)
        .build_cartesian_2d(left..right, bottom..top)
        .map_err(|error| words(&error))?;
    chart
        .configure_mesh()
        .x_desc("wall time [s]")
        .y_desc("error at the end [of the clearance]")
        .x_label_formatter(&decade)
        .y_label_formatter(&decade)
        .draw()
        .map_err(|error| words(&error))?;
    let mut names: Vec<String> = placed.iter().map(|(row, _)| name(row)).collect();
    names.dedup();
    for series in names {
        let rows = || placed.iter().filter(|(row, _)| name(row) == series);
        let Some((row, _)) = rows().next() else { continue };
        let (colour, size) = style(&row.way);
        let points = || rows().filter_map(|(_, at)| Some((at.time, at.error?)));
        chart
            .draw_series(LineSeries::new(points(), colour.mix(0.5)))
            .map_err(|error| words(&error))?;
        chart
            .draw_series(points().map(|at| Circle::new(at, size, colour.filled())))
            .map_err(|error| words(&error))?
            .label(series.clone())
            .legend(move |at| Circle::new(at, size, colour.filled()));
        // Errors of zero stand on the lower edge, which is none of their value.
        let zeros = rows().filter(|(_, at)| at.error.is_none()).map(|(_, at)| (at.time, bottom));
        chart
            .draw_series(zeros.map(|at| TriangleMarker::new(at, size + 2, colour.stroke_width(1))))
            .map_err(|error| words(&error))?;
    }
    if placed.iter().any(|(_, at)| at.error.is_none()) {
        chart
            .draw_series(std::iter::empty::<Circle<(f64, f64), i32>>())
            .map_err(|error| words(&error))?
            .label("error 0, off this scale")
            .legend(|at| TriangleMarker::new(at, 5, BLACK.stroke_width(1)));
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
