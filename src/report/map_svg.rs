//! The interaction map as an SVG picture, with the curves that bound its
//! zones. Verdicts differ in lightness as well as in colour, and sensitive
//! cells carry a dot.

use plotters::prelude::*;

use crate::motion::Verdict;
use crate::study::{Map, overlay::Curve};

/// Colour of a verdict, readable without colour vision.
pub(super) fn colour(verdict: Verdict) -> RGBColor {
    match verdict {
        Verdict::Decay => RGBColor(240, 240, 240),
        Verdict::Bounce => RGBColor(190, 210, 235),
        Verdict::Slip => RGBColor(240, 190, 70),
        Verdict::Locked => RGBColor(40, 70, 140),
        Verdict::Adhesive => RGBColor(200, 70, 90),
        Verdict::Failed => RGBColor(0, 0, 0),
    }
}

/// Draws the map.
///
/// # Errors
/// What the drawing backend says, in words.
pub fn draw(map: &Map, curves: &[Curve]) -> Result<String, String> {
    let mut svg = String::new();
    draw_on(&SVGBackend::with_string(&mut svg, (900, 600)).into_drawing_area(), map, curves)
        .map_err(|error| error.to_string())?;
    Ok(svg)
}

type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw_on<'a>(
    area: &DrawingArea<SVGBackend<'a>, plotters::coord::Shift>,
    map: &Map,
    curves: &[Curve],
) -> Drawn
where
    SVGBackend<'a>: DrawingBackend,
{
    let (x, y) = (&map.plan.x, &map.plan.y);
    area.fill(&WHITE).map_err(|error| error.to_string())?;
    let (right, top) = (f64::from(x.count) - 0.5, f64::from(y.count) - 0.5);
    let scene = &map.plan.scene;
    let caption = format!("{} ({} contact)", scene.title, scene.solver.contact);
    let mut chart = ChartBuilder::on(area)
        .caption(caption, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(48)
        .y_label_area_size(80)
        .build_cartesian_2d(-0.5..right, -0.5..top)
        .map_err(|error| error.to_string())?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc(&x.path)
        .y_desc(&y.path)
        .x_label_formatter(&|place| super::number::short(x.value_at(*place)))
        .y_label_formatter(&|place| super::number::short(y.value_at(*place)))
        .draw()
        .map_err(|error| error.to_string())?;
    for verdict in Verdict::ALL {
        let cells: Vec<(f64, f64)> = places(map, |cell| cell.verdict == verdict);
        if cells.is_empty() {
            continue;
        }
        let fill = colour(verdict).filled();
        chart
            .draw_series(cells.into_iter().map(|(column, row)| {
                Rectangle::new([(column - 0.5, row - 0.5), (column + 0.5, row + 0.5)], fill)
            }))
            .map_err(|error| error.to_string())?
            .label(verdict.as_ref())
            .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 12, y + 5)], fill));
    }
    let (dot, dots) = (RGBColor(120, 120, 120).filled(), places(map, |cell| cell.sensitive));
    if !dots.is_empty() {
        chart
            .draw_series(dots.into_iter().map(|at| Circle::new(at, 1.5, dot)))
            .map_err(|error| error.to_string())?
            .label("sensitive")
            .legend(move |(x, y)| Circle::new((x + 6, y), 1.5, dot));
    }
    for (curve, style) in curves.iter().zip([BLACK, RED, MAGENTA]) {
        let inside = curve.points.iter().map(|&(px, py)| (x.place(px), y.place(py)));
        let inside =
            inside.filter(|&(px, py)| (-0.5..=right).contains(&px) && (-0.5..=top).contains(&py));
        chart
            .draw_series(LineSeries::new(inside, style.stroke_width(2)))
            .map_err(|error| error.to_string())?
            .label(curve.name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 12, y)], style.stroke_width(2)));
    }
    chart
        .configure_series_labels()
        // Low speeds and strong pulses: there is least to cover.
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK)
        .draw()
        .map_err(|error| error.to_string())?;
    area.present().map_err(|error| error.to_string())?;
    Ok(())
}

/// Columns and rows of the cells that are chosen.
fn places(map: &Map, chosen: impl Fn(crate::study::Cell) -> bool) -> Vec<(f64, f64)> {
    let columns = map.plan.x.count as usize;
    map.cells
        .iter()
        .enumerate()
        .filter(|(_, cell)| cell.is_some_and(&chosen))
        .map(|(index, _)| ((index % columns) as f64, (index / columns) as f64))
        .collect()
}
