//! Blade-tip/casing rub of a flexible bladed disk in a flexible casing, after
//! Legrand, Pierre and Peseux (2010).

pub mod cli;
pub mod model;
pub mod motion;
pub mod scene;
