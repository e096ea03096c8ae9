//! The decimal mark of a table: comma or point. It follows from the numbers that can be read in one way
//! only. A number such as `1.300`, which may be 1300 or 1.3, leads to a question if no other number of
//! the table shows the mark, or if others show the other mark.

use anyhow::{Result, bail};

/// What the marks in a number can be.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Marks {
    /// One mark, which separates the decimals.
    Decimal(char),
    /// One mark before three digits: it separates decimals or thousands.
    Either(char),
    /// Several marks, a space or an apostrophe: some of them separate thousands.
    Thousands,
}

/// A number of a table.
pub(super) struct Number {
    /// Line and name of the value, for messages.
    pub path: String,
    /// The cell, which may contain a unit.
    pub cell: String,
}

/// Returns the decimal mark of a table with these numbers; the point if no number has a mark.
/// `point_is_sure` says that a lone point separates decimals, as in a file with commas between the
/// cells.
///
/// # Errors
/// A number can be read in two ways, or has marks between thousands.
pub(super) fn decimal_mark(numbers: &[Number], point_is_sure: bool) -> Result<char> {
    let marked: Vec<_> =
        numbers.iter().filter_map(|number| Some((number, number.marks()?))).collect();
    if let Some((number, _)) = marked.iter().find(|(_, marks)| *marks == Marks::Thousands) {
        bail!(number.asked(&format!("is that {}", number.without_thousands())));
    }
    let sure = marked.iter().find_map(|(number, marks)| match marks {
        Marks::Decimal(mark) => Some((*mark, *number)),
        _ => None,
    });
    let shown = sure.map(|(mark, _)| mark).or(point_is_sure.then_some('.'));
    let is_other = |mark: &char| Some(*mark) != shown;
    let either = |marks: &Marks| matches!(marks, Marks::Either(mark) if is_other(mark));
    if let Some((number, _)) = marked.iter().find(|(_, marks)| either(marks)) {
        bail!(number.either(shown, sure.map(|(_, number)| number)));
    }
    let differs = |marks: &Marks| matches!(marks, Marks::Decimal(mark) if is_other(mark));
    if let Some((_, Number { path, cell })) = sure
        && let Some((number, _)) = marked.iter().find(|(_, marks)| differs(marks))
    {
        bail!(number.asked(&format!(
            "which is the decimal mark, that of this number or that of {path}, {cell}"
        )));
    }
    Ok(shown.unwrap_or('.'))
}

impl Number {
    /// Returns the digits and marks at the start of the cell, without a sign, and what follows.
    fn parts(&self) -> (&str, &str) {
        let cell = self.cell.trim_start_matches(['+', '-']);
        let is_part = |c: char| c.is_ascii_digit() || "., '’\u{a0}\u{2009}\u{202f}".contains(c);
        let (start, _) = cell.split_at(cell.find(|c| !is_part(c)).unwrap_or(cell.len()));
        let number =
            start.trim_end_matches(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | ',')));
        (number, cell.get(number.len()..).unwrap_or_default())
    }

    fn marks(&self) -> Option<Marks> {
        let (number, rest) = self.parts();
        let (whole, decimals) = number.split_once(|c: char| !c.is_ascii_digit())?;
        let mark = number.chars().find(|c| !c.is_ascii_digit())?;
        if !matches!(mark, '.' | ',') || !decimals.bytes().all(|byte| byte.is_ascii_digit()) {
            return Some(Marks::Thousands);
        }
        // 1.300e3, 0.300 and 1300.000 have no mark between thousands.
        let fits = decimals.len() == 3 && (1..=3).contains(&whole.len()) && !whole.starts_with('0');
        let is_either = fits && !rest.starts_with(['e', 'E', 'd', 'D']);
        Some(if is_either { Marks::Either(mark) } else { Marks::Decimal(mark) })
    }

    /// Returns the number without what separates its thousands.
    fn without_thousands(&self) -> String {
        let (number, _) = self.parts();
        let is_mark = |c: char| matches!(c, '.' | ',');
        let last = number.rfind(is_mark).filter(|at| {
            let mark = number[*at..].chars().next();
            number.chars().filter(|c| Some(*c) == mark).count() == 1
        });
        let kept = number.char_indices().filter(|(at, c)| c.is_ascii_digit() || Some(*at) == last);
        kept.map(|(_, c)| c).collect()
    }

    /// Asks whether the mark separates decimals or thousands. `shown` is the decimal mark of the
    /// table, `sure` a number that has it.
    fn either(&self, shown: Option<char>, sure: Option<&Number>) -> String {
        let (number, _) = self.parts();
        let (whole, decimals) = number.split_once(['.', ',']).unwrap_or((number, ""));
        let own = if number.contains(',') { ',' } else { '.' };
        let mark = shown.unwrap_or(own);
        let beside =
            sure.map_or(String::new(), |other| format!(" (beside {}, {})", other.path, other.cell));
        self.asked(&format!("is that {whole}{mark}{decimals}0 or {whole}{decimals}{beside}"))
    }

    fn asked(&self, question: &str) -> String {
        let Self { path, cell } = self;
        format!("{path} = {cell}: {question}? Write it so, without marks between thousands")
    }
}
