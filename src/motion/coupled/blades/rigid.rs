//! Blades that do not move: only the casing feels contact.

use std::sync::Arc;

use super::TipModel;
use crate::model::Machine;
use crate::motion::Plane;
use crate::motion::coupled::rows::RowTable;
use crate::motion::explicit::Driven;
use crate::scene::Scene;

/// No blade coordinate; a row is a side.
#[derive(Clone, Debug)]
pub(in crate::motion) struct RigidTips {
    table: Arc<RowTable>,
    angles: Arc<[f64]>,
    blades: usize,
}

impl TipModel for RigidTips {
    fn at_rest(_: &Scene, machine: &Machine, _: Driven<'_>) -> Self {
        let table = RowTable::new(machine, machine.polygon.blades_per_side);
        let angles = vec![0.0; table.count()].into();
        Self { table: Arc::new(table), angles, blades: machine.polygon.blades as usize }
    }
    fn with_parameters(&self, _: &Scene, _: &Machine) -> Self {
        self.clone()
    }
    fn coordinates(&self) -> usize {
        2
    }
    fn table(&self) -> &RowTable {
        &self.table
    }
    fn wave(&self) -> Option<Plane> {
        Some(Plane::default())
    }
    fn predict(&mut self, _: Driven<'_>) {}
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
    fn begin(&mut self, _: u32, _: f64) {}
    fn bound(&mut self) -> f64 {
        0.0
    }
    fn estimates(&mut self) -> (&RowTable, &[f64], f64) {
        (&self.table, &self.angles, 0.0)
    }
    fn largest(&mut self) -> f64 {
        0.0
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
    fn reach(&self) -> f64 {
        0.0
    }
    fn modal(&self) -> ([f64; 2], [f64; 2]) {
        ([0.0; 2], [0.0; 2])
    }
    fn every_angle(&self) -> Vec<f64> {
        vec![0.0; self.blades]
    }
}
