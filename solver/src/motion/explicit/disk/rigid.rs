//! Blades that do not move: only the casing feels contact.

use std::sync::Arc;

use super::{Columns, Disk, HeldModes, RowTable};
use crate::model::Machine;
use crate::motion::Plane;
use crate::motion::explicit::{Coordinate, Driven};
use crate::scene::Scene;

/// No blade coordinate; a row is a side, or a blade where tips have lengths of their own.
#[derive(Clone, Debug)]
pub struct RigidBlades {
    table: Arc<RowTable>,
    blades: usize,
}

impl Disk for RigidBlades {
    fn at_rest(_: &Scene, machine: &Machine, _: Driven<'_>) -> Self {
        let polygon = &machine.polygon;
        let alike = if machine.is_uneven() { 1 } else { polygon.blades_per_side };
        let table = RowTable::new(machine, alike);
        Self { table: Arc::new(table), blades: polygon.blades as usize }
    }
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self {
        Self::at_rest(scene, machine, None)
    }
    fn coordinates(&self) -> usize {
        2
    }
    fn table(&self) -> &RowTable {
        &self.table
    }
    fn predict(&mut self, _: Driven<'_>) -> f64 {
        0.0
    }
    fn angle(&mut self, _: u32) -> f64 {
        0.0
    }
    fn angle_before(&mut self, _: u32) -> f64 {
        0.0
    }
    fn compliance(&self, _: u32, _: u32) -> f64 {
        0.0
    }
    fn correct(&mut self, _: u32, _: f64) {}
    fn push(&mut self, _: &Columns, _: [f64; 2]) -> f64 {
        0.0
    }
    fn swept(&mut self, _: &Columns) -> f64 {
        0.0
    }
    fn begin(&mut self, _: &Columns, _: [f64; 2]) {}
    fn modal(&self) -> [f64; 2] {
        [0.0; 2]
    }
    fn modal_rates(&self, _: &Self, _: f64) -> [f64; 2] {
        [0.0; 2]
    }
    fn every_angle(&self) -> Vec<f64> {
        vec![0.0; self.blades]
    }
    fn look(&mut self, _: f64) -> (f64, f64) {
        (0.0, 0.0)
    }
    fn reach(&self) -> f64 {
        0.0
    }
    fn peak(&self, _: u64, least: f64) -> f64 {
        least
    }
    fn skip(&mut self, _: u64) {}
    fn held_modes(&self) -> Option<HeldModes<'_>> {
        Some(HeldModes { modes: [Coordinate::default(); 2], moving: None })
    }
    fn bound(&mut self) -> f64 {
        0.0
    }
    fn wave(&self) -> Option<Plane> {
        Some(Plane::default())
    }
    fn estimates(&mut self) -> (&RowTable, &[f64], f64) {
        (&self.table, &[], 0.0)
    }
    fn swing(&mut self) -> f64 {
        0.0
    }
    fn energy(&self) -> f64 {
        0.0
    }
    fn flows(&self) -> [f64; 2] {
        [0.0; 2]
    }
}
