//! Curves as time bins with the minimum and maximum of each channel, so that a contact
//! peak of a single step is visible at any zoom.

/// Recorded quantities. The number of a channel is its index in `Bin::low` and `Bin::high`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Cosine coordinate of the casing, `u_c` \[m\].
    UC,
    /// Sine coordinate of the casing, `u_s` \[m\].
    US,
    /// Cosine coordinate of the blades, `alpha_c` \[rad\].
    AlphaC,
    /// Sine coordinate of the blades, `alpha_s` \[rad\].
    AlphaS,
    /// The smallest gap of any blade \[m\].
    Gap,
    /// Amplitude of the casing wave relative to the blade tips, `|w|` \[m\].
    Amplitude,
    /// Sum of all contact forces, positive for a push \[N\].
    Push,
    /// Real part of the casing wave in the blade frame, `Re z` \[m\].
    X,
    /// Imaginary part of the casing wave in the blade frame, `Im z` \[m\].
    Y,
    /// Real part of the casing wave relative to the blade tips, `Re w` \[m\].
    RimX,
    /// Imaginary part of the casing wave relative to the blade tips, `Im w` \[m\].
    RimY,
}

/// Number of channels.
pub const CHANNELS: usize = 11;

/// Minimum and maximum of every channel over an interval of simulated time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Start of the interval \[s\].
    pub from: f64,
    /// End of the interval \[s\].
    pub to: f64,
    /// Minimum of every channel.
    pub low: [f64; CHANNELS],
    /// Maximum of every channel.
    pub high: [f64; CHANNELS],
    /// First and last time of contact in the interval \[s\]; `None` if nothing touches.
    pub contact: Option<(f64, f64)>,
}

impl Bin {
    /// Creates a bin from one sample.
    pub fn of(t: f64, values: [f64; CHANNELS]) -> Self {
        Self { from: t, to: t, low: values, high: values, contact: None }
    }

    /// Returns the minimum and maximum of a channel.
    pub fn span(&self, channel: Channel) -> (f64, f64) {
        (self.low[channel as usize], self.high[channel as usize])
    }

    /// Returns the middle of the span of a channel.
    pub fn middle(&self, channel: Channel) -> f64 {
        let (low, high) = self.span(channel);
        0.5 * (low + high)
    }

    /// Extends this bin by a later one.
    pub fn join(&mut self, later: &Self) {
        self.to = later.to;
        for k in 0..CHANNELS {
            self.low[k] = self.low[k].min(later.low[k]);
            self.high[k] = self.high[k].max(later.high[k]);
        }
        self.contact = self.contact.into_iter().chain(later.contact).reduce(wider);
    }
}

/// Largest length of a bin in [`fine_between`], as a fraction of the page.
const PART_OF_PAGE: f64 = 1.0 / 400.0;

/// Minimum and maximum of the data in one column of a chart; `None` for a column without data.
pub type Span = Option<(f64, f64)>;

/// Returns the bins that overlap `[from, to]`.
pub fn between(bins: &[Bin], from: f64, to: f64) -> &[Bin] {
    let start = bins.partition_point(|bin| bin.to < from);
    let end = bins.partition_point(|bin| bin.from <= to);
    bins.get(start..end.max(start)).unwrap_or(&[])
}

/// As [`between`], but empty if some bin is long enough to appear as a block.
pub fn fine_between(bins: &[Bin], from: f64, to: f64) -> &[Bin] {
    let (bins, longest) = (between(bins, from, to), PART_OF_PAGE * (to - from));
    if bins.iter().all(|bin| bin.to - bin.from <= longest) { bins } else { &[] }
}

/// Returns the bin that contains the time `t` \[s\], for reading values at the cursor; `None` if
/// nothing was recorded there.
pub fn bin_at(bins: &[Bin], t: f64) -> Option<&Bin> {
    bins.get(bins.partition_point(|bin| bin.to < t)).filter(|bin| bin.from <= t)
}

/// Reduces one channel of some bins over `[from, to]` to `columns` columns; `None` for a column
/// without data. Bins with values that are not finite are skipped. The span of a bin is widened to
/// meet that of the bin that ends where it starts, so that curves have no gaps.
pub fn columns(
    bins: &[Bin],
    channel: Channel,
    (from, to): (f64, f64),
    columns: usize,
) -> Vec<Span> {
    let mut out: Vec<Span> = vec![None; columns];
    let width = (to - from) / columns.max(1) as f64;
    if width.is_nan() || width <= 0.0 {
        return out;
    }
    let last = columns.saturating_sub(1);
    let mut before: Option<&Bin> = None;
    for bin in bins.iter().filter(|bin| bin.to >= from && bin.from <= to) {
        let before = before.replace(bin).filter(|before| before.to == bin.from);
        let (mut low, mut high) = bin.span(channel);
        if let Some((least, most)) = before.map(|before| before.span(channel)) {
            (low, high) = (low.min(most), high.max(least));
        }
        if !(low.is_finite() && high.is_finite()) {
            continue;
        }
        let place = |t: f64| (((t - from) / width).max(0.0) as usize).min(last);
        for slot in out.iter_mut().take(place(bin.to) + 1).skip(place(bin.from)) {
            *slot = Some(match *slot {
                Some((a, b)) => (a.min(low), b.max(high)),
                None => (low, high),
            });
        }
    }
    out
}

/// Returns which of `columns` columns of `[from, to]` have contact. Only the first and the last
/// instant in each bin count, which suffices because a page has more bins than columns.
pub fn contacts(bins: &[Bin], (from, to): (f64, f64), columns: usize) -> Vec<bool> {
    let mut out = vec![false; columns];
    let width = (to - from) / columns.max(1) as f64;
    for (first, last) in bins.iter().filter_map(|bin| bin.contact) {
        for t in [first, last].into_iter().filter(|t| (from..=to).contains(t) && width > 0.0) {
            let place = (((t - from) / width) as usize).min(columns.saturating_sub(1));
            out.iter_mut().skip(place).take(1).for_each(|column| *column = true);
        }
    }
    out
}

/// Returns the smallest interval that contains both.
pub fn wider((a, b): (f64, f64), (low, high): (f64, f64)) -> (f64, f64) {
    (a.min(low), b.max(high))
}

/// Splits bins longer than 1.5 times `length` into shorter ones with linearly interpolated values,
/// within `[from, to]` (all in seconds). A time-stepping solver gives no values between its steps.
pub fn interpolated(bins: &[Bin], length: f64, (from, to): (f64, f64)) -> Vec<Bin> {
    let mut out = Vec::with_capacity(bins.len());
    let mut last: Option<&Bin> = None;
    for bin in bins {
        let before = last.replace(bin).filter(|_| bin.to - bin.from > 1.5 * length);
        let Some(before) = before else {
            out.push(*bin);
            continue;
        };
        let span = bin.to - bin.from;
        let count = (span / length).ceil();
        let at = |place: f64| bin.from + span * place / count;
        let mut place = ((from - bin.from) / span * count).floor().clamp(0.0, count);
        while place < count && at(place) <= to {
            let part = (place + 1.0) / count;
            let middle = |bin: &Bin, k: usize| 0.5 * (bin.low[k] + bin.high[k]);
            let line = |k| middle(before, k) + part * (middle(bin, k) - middle(before, k));
            let values = std::array::from_fn(line);
            let mut piece = Bin { to: at(place + 1.0), ..Bin::of(at(place), values) };
            piece.contact = bin
                .contact
                .map(|(first, last)| (first.max(piece.from), last.min(piece.to)))
                .filter(|(first, last)| first <= last);
            out.push(piece);
            place += 1.0;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bin(from: f64, to: f64, value: f64) -> Bin {
        let mut bin = Bin::of(from, [value; CHANNELS]);
        bin.to = to;
        bin
    }

    fn ramp(count: u32) -> Vec<Bin> {
        let of = |k: u32| bin(f64::from(k), f64::from(k) + 0.999, f64::from(k));
        (0..count).map(of).collect()
    }

    #[test]
    fn a_peak_of_one_bin_survives_any_width() {
        let mut bins = ramp(1000);
        bins[517].high[Channel::Push as usize] = 1e6;
        for columns in [1, 7, 40, 300, 2000] {
            let top = super::columns(&bins, Channel::Push, (0.0, 1000.0), columns)
                .into_iter()
                .flatten()
                .map(|(_, high)| high)
                .fold(0.0, f64::max);
            assert_eq!(top, 1e6, "{columns} columns");
        }
    }

    #[test]
    fn columns_beyond_the_data_are_empty_and_nothing_leaks_across_pages() {
        let bins = ramp(10);
        let shown =
            |from, to, count| columns(between(&bins, from, to), Channel::UC, (from, to), count);
        let columns = shown(0.0, 20.0, 20);
        assert_eq!(columns.iter().flatten().count(), 10);
        assert_eq!(columns[3], Some((3.0, 3.0)));
        assert!(shown(20.0, 40.0, 8).iter().all(Option::is_none));
        assert!(shown(5.0, 5.0, 8).iter().all(Option::is_none));
    }

    #[test]
    fn not_a_number_never_reaches_a_column() {
        let mut bins = ramp(3);
        bins.extend([bin(3.0, 4.0, f64::NAN), bin(4.0, 5.0, f64::INFINITY)]);
        for span in columns(&bins, Channel::UC, (0.0, 6.0), 12).into_iter().flatten() {
            assert!(span.0.is_finite() && span.1.is_finite());
        }
    }
}
