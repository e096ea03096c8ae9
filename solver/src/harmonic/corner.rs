//! Corners of the polygon: the two phase groups that hold a locked wave (docs/theory.md, section
//! 3), named by blade numbers as in the paper (#6 and #21).

use super::error;
use crate::model::{ContactPolygon, Machine};
use crate::scene::SceneError;

/// The pair of blades in the paper.
pub const PAPER_PAIR: [u32; 2] = [6, 21];

/// Two neighbouring sides in the order of their phase; `psi_b = psi_a + 2 delta` for equal tips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    /// Side with the phase `psi_a`.
    pub a: u32,
    /// Side with the phase `psi_b`.
    pub b: u32,
}

impl Corner {
    /// Returns the corner between side `a` and the next one in the direction of increasing phase.
    ///
    /// # Errors
    /// The polygon has no corners.
    pub fn after(polygon: &ContactPolygon, a: u32) -> Result<Self, SceneError> {
        error::refuse_no_corner(polygon)?;
        let a = a % polygon.sides;
        Ok(Self { a, b: polygon.next(a) })
    }

    /// Returns the corner of a machine that holds the wave: the one between `blades`, or, if
    /// `None`, the default corner for equal tips and the corner that is held at the lowest speed
    /// for unequal ones.
    ///
    /// # Errors
    /// The polygon has no corners, no corner of the tips is ever held, or the blades do not form a
    /// corner.
    pub fn of(machine: &Machine, speed: f64, blades: Option<[u32; 2]>) -> Result<Self, SceneError> {
        let polygon = &machine.polygon;
        if !machine.has_unequal_tips() {
            return blades
                .map_or_else(|| Self::paper(polygon), |pair| Self::of_blades(polygon, pair));
        }
        error::refuse_no_corner(polygon)?;
        let Some(blades) = blades else {
            let lowest = machine.lowest_corner(speed).map(|(corner, _)| corner.sides);
            return lowest.map(|[a, b]| Self { a, b }).ok_or_else(error::no_corner_of_tips);
        };
        let pair = blades.map(|blade| polygon.side_of_blade(blade));
        let corners = machine.tip_corners();
        let of_pair = corners.iter().find(|corner| pair.iter().all(|x| corner.sides.contains(x)));
        of_pair.map(|corner| Self { a: corner.sides[0], b: corner.sides[1] }).ok_or_else(|| {
            let name = |side: u32| polygon.blades_of_side(side)[0].to_string();
            let pairs = corners.iter().map(|corner| corner.sides.map(name).join(","));
            error::no_pair(blades, format!("one of {}", pairs.collect::<Vec<_>>().join(" or ")))
        })
    }

    /// Returns the default corner: that of the paper's blades 6 and 21 if these are phase
    /// neighbours, otherwise the corner that starts nearest to their phase, at side `15 N'/22`
    /// rounded.
    ///
    /// # Errors
    /// The polygon has no corners.
    pub fn paper(polygon: &ContactPolygon) -> Result<Self, SceneError> {
        if polygon.has_corners() && polygon.blades >= PAPER_PAIR[1] {
            let [a, b] = PAPER_PAIR.map(|blade| polygon.side_of_blade(blade));
            if polygon.next(a) == b {
                return Ok(Self { a, b });
            }
        }
        let nearest = (f64::from(polygon.sides) * 15.0 / 22.0).round();
        Self::after(polygon, nearest as u32)
    }

    /// Returns the corner between the groups of two blades, numbered from 1 and given in either
    /// order.
    ///
    /// # Errors
    /// A blade does not exist, or the groups are not neighbours in phase; the message names the
    /// neighbours.
    pub fn of_blades(
        polygon: &ContactPolygon,
        [first, second]: [u32; 2],
    ) -> Result<Self, SceneError> {
        error::refuse_no_corner(polygon)?;
        let refused = |allowed| Err(error::no_pair([first, second], allowed));
        if ![first, second].iter().all(|blade| (1..=polygon.blades).contains(blade)) {
            return refused(format!("two blades from 1 to {}", polygon.blades));
        }
        let (a, b) = (polygon.side_of_blade(first), polygon.side_of_blade(second));
        if polygon.next(a) == b {
            Ok(Self { a, b })
        } else if polygon.next(b) == a {
            Ok(Self { a: b, b: a })
        } else {
            let list = |side| {
                polygon
                    .blades_of_side(side)
                    .iter()
                    .map(u32::to_string)
                    .collect::<Vec<_>>()
                    .join(" or ")
            };
            refused(format!(
                "a pair of phase neighbours; those of blade {first} are {} and {}",
                list(polygon.previous(a)),
                list(polygon.next(a))
            ))
        }
    }

    /// Returns both sides, `[a, b]`.
    #[must_use]
    pub fn sides(self) -> [u32; 2] {
        [self.a, self.b]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_pair_in_either_order_and_the_22_corners() {
        let polygon = ContactPolygon::new(22, 3, 1e-4);
        let paper = Corner::paper(&polygon).unwrap();
        assert_eq!(paper, Corner { a: 15, b: 16 });
        assert_eq!(Corner::of_blades(&polygon, [6, 21]), Ok(paper));
        assert_eq!(Corner::of_blades(&polygon, [21, 6]), Ok(paper));
        let pairs = (1..=22)
            .flat_map(|i| (i + 1..=22).map(move |j| [i, j]))
            .filter(|&pair| Corner::of_blades(&polygon, pair).is_ok());
        assert_eq!(pairs.count(), 22);
    }

    #[test]
    fn what_is_not_a_corner_is_refused_by_name() {
        let polygon = ContactPolygon::new(22, 3, 1e-4);
        let message = Corner::of_blades(&polygon, [6, 7]).unwrap_err().to_string();
        assert!(message.starts_with("blades = 6,7: allowed is a pair of phase"), "{message}");
        assert!(message.ends_with("those of blade 6 are 13 and 21"), "{message}");
        let message = Corner::of_blades(&polygon, [6, 23]).unwrap_err().to_string();
        assert_eq!(message, "blades = 6,23: allowed is two blades from 1 to 22");
        assert!(Corner::of_blades(&polygon, [6, 6]).is_err());
        for diameters in [0, 11, 22] {
            let polygon = ContactPolygon::new(22, diameters, 1e-4);
            let message = Corner::paper(&polygon).unwrap_err().to_string();
            let start = format!("operation.nodal_diameters = {diameters}: allowed is");
            assert!(message.starts_with(&start), "{message}");
            assert!(message.contains("a corner needs three sides"), "{message}");
        }
    }

    #[test]
    fn every_rim_with_corners_has_a_default() {
        for blades in 3..40 {
            for diameters in 1..12 {
                let polygon = ContactPolygon::new(blades, diameters, 1e-4);
                match Corner::paper(&polygon) {
                    Ok(corner) => assert_eq!(polygon.next(corner.a), corner.b),
                    Err(_) => assert!(polygon.sides < 3),
                }
            }
        }
        assert_eq!(Corner::paper(&ContactPolygon::new(22, 4, 1.0)).unwrap().a, 8);
    }
}
