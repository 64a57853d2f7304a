//! Lines with no more points than a picture can show.

/// A place in a panel, in the units of its axes.
pub type Point = [f64; 2];

/// A line in stretches: between two of them it is broken.
pub type Line = Vec<Vec<Point>>;

/// A column with more breaks than this is drawn as one stretch.
const MOST_BREAKS: usize = 2;

/// So many points of a column are held at a time.
const HELD: usize = 64;

/// Takes the points of a line in order of x and keeps, of those that share a column, the
/// lowest and the highest: about two a column, and no peak is lost.
///
/// Where breaks are so close that neighbouring columns are full, the line runs on.
#[derive(Debug)]
pub(super) struct Thinner {
    low: f64,
    width: f64,
    column: i64,
    /// The points of this column, each with whether a stretch begins there.
    group: Vec<(Point, bool)>,
    /// Whether this column has had too many breaks.
    crowded: bool,
    /// Whether the column before had too many.
    was_crowded: bool,
    broken: bool,
    line: Line,
}

impl Thinner {
    /// For x from `low` to `high`, in so many columns.
    pub(super) fn new([low, high]: [f64; 2], columns: usize) -> Thinner {
        let width = (high - low).max(f64::MIN_POSITIVE) / columns.max(1) as f64;
        Thinner {
            low,
            width,
            column: 0,
            group: Vec::new(),
            crowded: false,
            was_crowded: false,
            broken: true,
            line: Vec::new(),
        }
    }

    /// Breaks the line: the next point begins a stretch.
    pub(super) fn split(&mut self) {
        self.broken = true;
    }

    /// Adds a point; one that is not finite breaks the line instead.
    pub(super) fn push(&mut self, point: Point) {
        if !point.iter().all(|c| c.is_finite()) {
            return self.split();
        }
        let column = ((point[0] - self.low) / self.width).floor() as i64;
        if column != self.column {
            self.close_column();
            self.column = column;
        }
        if self.group.len() == HELD {
            self.crowded |= self.breaks() > MOST_BREAKS;
            self.group = extremes(&self.group);
        }
        self.group.push((point, self.broken));
        self.broken = false;
    }

    /// The line as far as it goes.
    pub(super) fn finish(mut self) -> Line {
        self.close_column();
        self.line
    }

    /// How many stretches of the column begin after its first point.
    fn breaks(&self) -> usize {
        self.group.iter().skip(1).filter(|(_, starts)| *starts).count()
    }

    fn close_column(&mut self) {
        let crowded = self.crowded || self.breaks() > MOST_BREAKS;
        let group = std::mem::take(&mut self.group);
        let kept: Vec<(Point, bool)> = if crowded {
            extremes(&group)
        } else {
            let parts: Vec<_> = group.chunk_by(|_, (_, starts)| !starts).collect();
            parts.iter().enumerate().flat_map(|(i, part)| ends(part, i + 1 < parts.len())).collect()
        };
        for (i, (point, starts)) in kept.into_iter().enumerate() {
            let runs_on = !starts || (i == 0 && crowded && self.was_crowded);
            match self.line.last_mut().filter(|_| runs_on) {
                Some(stretch) => stretch.push(point),
                None => self.line.push(vec![point]),
            }
        }
        (self.was_crowded, self.crowded) = (crowded, false);
    }
}

/// Of the points of a column between two breaks the lowest and the highest, and beside a
/// break the ends, lest a jump stand elsewhere than it does.
fn ends(part: &[(Point, bool)], breaks_off: bool) -> Vec<(Point, bool)> {
    let mut kept = extremes(part);
    let (start, end) = (part[0], part[part.len() - 1]);
    if start.1 && kept[0].0 != start.0 {
        kept[0].1 = false;
        kept.insert(0, start);
    }
    if breaks_off && kept[kept.len() - 1].0 != end.0 {
        kept.push((end.0, false));
    }
    kept
}

/// The lowest and the highest of some points, in their order; a break before the first of
/// them stays.
fn extremes(points: &[(Point, bool)]) -> Vec<(Point, bool)> {
    if points.len() <= 2 {
        return points.to_vec();
    }
    let y = |i: &usize| points[*i].0[1];
    let indices = 0..points.len();
    let lowest = indices.clone().min_by(|a, b| y(a).total_cmp(&y(b))).unwrap_or(0);
    let highest = indices.max_by(|a, b| y(a).total_cmp(&y(b))).unwrap_or(0);
    let (first, second) = (lowest.min(highest), lowest.max(highest));
    let mut kept = vec![(points[first].0, points[0].1)];
    if second != first {
        kept.push((points[second].0, false));
    }
    kept
}

/// A line with about two points a column of x.
pub(super) fn thinned(line: &[Vec<Point>], range: [f64; 2], columns: usize) -> Line {
    let mut thinner = Thinner::new(range, columns);
    for stretch in line {
        thinner.split();
        stretch.iter().for_each(|&point| thinner.push(point));
    }
    thinner.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_points_stay_as_they_are() {
        let line = vec![vec![[0.0, 1.0], [4.0, 2.0]], vec![[4.0, 7.0], [10.0, 3.0]]];
        assert_eq!(thinned(&line, [0.0, 10.0], 100), line);
    }

    #[test]
    fn many_points_become_two_a_column_and_keep_their_peaks() {
        let wave = |i: usize| if i == 70_123 { 9.0 } else { (i as f64 * 0.37).sin() };
        let line = vec![(0..100_000).map(|i| [i as f64, wave(i)]).collect::<Vec<_>>()];
        let thin = thinned(&line, [0.0, 1e5], 500);
        assert_eq!(thin.len(), 1);
        assert!((900..=1002).contains(&thin[0].len()), "{}", thin[0].len());
        assert!(thin[0].contains(&[70_123.0, 9.0]));
        assert!(thin[0].windows(2).all(|pair| pair[0][0] <= pair[1][0]));
    }

    #[test]
    fn breaks_stay_unless_they_are_too_many_to_be_seen() {
        let steps = |n: usize| -> Line {
            (0..n)
                .map(|i| (0..=8).map(|j| [i as f64 + f64::from(j) / 8.0, (i % 2) as f64]).collect())
                .collect()
        };
        assert_eq!(thinned(&steps(10), [0.0, 10.0], 40).len(), 10);
        let many = thinned(&steps(10_000), [0.0, 10_000.0], 500);
        assert!(many.len() == 1 && many[0].len() <= 1002, "{} {}", many.len(), many[0].len());
        // Ten points a column, and now and then a break among them.
        let few = thinned(&steps(40), [0.0, 40.0], 36);
        assert_eq!(few.len(), 40);
        for (i, stretch) in few.iter().enumerate() {
            assert_eq!((stretch[0][0], stretch[stretch.len() - 1][0]), (i as f64, (i + 1) as f64));
        }
    }

    #[test]
    fn what_is_not_finite_breaks_the_line() {
        let line = vec![vec![[0.0, 1.0], [1.0, f64::NAN], [2.0, f64::INFINITY], [3.0, 2.0]]];
        assert_eq!(thinned(&line, [0.0, 3.0], 100), [vec![[0.0, 1.0]], vec![[3.0, 2.0]]]);
    }
}
