//! The data of a figure as tables, one per panel.

use super::table::{Table, TableCell};
use rubscope_solver::study::figures::Panel;

/// Returns the data of a panel. If all series have points at the same x, there is one column for x
/// and one per series; otherwise one row per point, with the name of its series.
pub fn table(panel: &Panel) -> Table<'_> {
    if !panel.shares_x() {
        let headings = ["series".into(), panel.x.column.clone(), panel.y.column.clone()];
        let rows = panel.series.iter().flat_map(|series| {
            let row = |&(x, y): &(f64, f64)| vec![series.name.as_str().into(), x.into(), y.into()];
            series.points.iter().map(row)
        });
        return Table::with_rows(headings, rows.collect());
    }
    let unit = panel.y.column.split_once('_').map_or("", |(_, unit)| unit);
    let names = panel
        .series
        .iter()
        .map(|series| format!("{}_{unit}", series.name.replace(", ", "_").replace(' ', "_")));
    let headings = std::iter::once(panel.x.column.to_string()).chain(names);
    let xs = panel.series.first().map(|series| series.points.as_slice()).unwrap_or_default();
    Table::new(headings, xs.len(), move |row| {
        let values = panel.series.iter().map(|series| series.points.get(row).map(|point| point.1));
        std::iter::once(xs[row].0.into()).chain(values.map(TableCell::from)).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rubscope_solver::study::figures::{Quantity, Series, Style};

    fn text(points: [&[(f64, f64)]; 2]) -> String {
        let [a, b] = points.map(|points| points.iter().copied());
        let series =
            vec![Series::new("u c", Style::Faint, a), Series::new("u s, damped", Style::Faint, b)];
        let y = Quantity::new("u_m", "u", 1e6);
        let mut out = Vec::new();
        table(&Panel::new("", Quantity::TIME, y, series)).write_csv(&mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn series_over_the_same_x_stand_side_by_side() {
        let shared = text([&[(0.0, 1.0), (0.5, 2.0)], &[(0.0, 3.0), (0.5, 4.0)]]);
        assert_eq!(shared, "t_s,u_c_m,u_s_damped_m\n0,1,3\n0.5,2,4\n");
    }

    #[test]
    fn others_stand_below_each_other() {
        let apart = text([&[(0.0, 1.0)], &[(0.5, 4.0)]]);
        assert_eq!(apart, "series,t_s,u_m\nu c,0,1\n\"u s, damped\",0.5,4\n");
    }
}
