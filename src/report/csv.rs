//! A history as CSV: a header line, then one line per sample. Numbers are the
//! shortest that read back as the same value.

use std::io::Write;

use super::History;

/// Writes a history.
///
/// # Errors
/// What the writer refuses.
pub fn write(history: &History, out: &mut dyn Write) -> std::io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(history.columns().iter().map(|column| &column.name))?;
    for row in 0..history.len() {
        let values = history.columns().iter().filter_map(|column| column.values.get(row));
        csv.write_record(values.map(|value| exact(*value)))?;
    }
    csv.flush()
}

/// The shortest text that reads back as this number.
pub(super) fn exact(x: f64) -> String {
    if x != 0.0 && !(1e-4..1e15).contains(&x.abs()) { format!("{x:e}") } else { x.to_string() }
}

#[cfg(test)]
mod tests {
    use super::super::history::tests::sample;
    use super::*;

    #[test]
    fn every_number_reads_back_as_itself() {
        let mut history = History::new(3);
        history.push(&sample(0.1 + 0.2));
        history.push(&sample(1.0 / 3.0 * 1e-9));
        let mut text = Vec::new();
        write(&history, &mut text).unwrap();
        let mut reader = csv::Reader::from_reader(text.as_slice());
        let names: Vec<String> = reader.headers().unwrap().iter().map(String::from).collect();
        let mut rows = 0;
        for (row, record) in reader.records().enumerate() {
            for (index, cell) in record.unwrap().iter().enumerate() {
                let column = &history.columns()[index];
                assert_eq!(column.name, names[index]);
                assert_eq!(cell.parse::<f64>().unwrap(), column.values[row]);
            }
            rows += 1;
        }
        assert_eq!(rows, 2);
    }
}
