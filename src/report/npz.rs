//! A history for numpy: `numpy.load(file)["u_c_m"]` is the column of that
//! name. An `.npz` is a zip of `.npy` arrays; an `.npy` is a short text header
//! and the numbers, little end first.

use std::io::Write;

use super::History;
use super::zip::Archive;

/// Writes a history.
///
/// # Errors
/// What the writer refuses, or more than the 4 GB a plain zip can hold.
pub fn write(history: &History, out: &mut dyn Write) -> std::io::Result<()> {
    let mut archive = Archive::new(out);
    for column in history.columns() {
        archive.add(&format!("{}.npy", column.name), &array(&column.values))?;
    }
    archive.finish()
}

/// One array in numpy's format, version 1.0.
fn array(values: &[f64]) -> Vec<u8> {
    let mut header =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}", values.len());
    // Magic, version, length and header together fill whole lines of 64 bytes.
    const BEFORE: usize = 10;
    let padding = 63 - (BEFORE + header.len()) % 64;
    header.extend(std::iter::repeat_n(' ', padding));
    header.push('\n');
    let length = u16::try_from(header.len()).unwrap_or(u16::MAX);
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(length.to_le_bytes());
    bytes.extend(header.into_bytes());
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_aligned_and_hold_the_numbers() {
        for count in [0, 1, 9, 10, 12_345] {
            let values: Vec<f64> = (0..count).map(|n| f64::from(n) / 3.0).collect();
            let bytes = array(&values);
            let header = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
            assert_eq!(header % 64, 0);
            let text = std::str::from_utf8(&bytes[10..header]).unwrap();
            assert!(text.contains(&format!("'shape': ({count},)")) && text.ends_with('\n'));
            let numbers: Vec<f64> = bytes[header..]
                .chunks_exact(8)
                .map(|chunk| f64::from_le_bytes(chunk.try_into().unwrap()))
                .collect();
            assert_eq!(numbers, values);
        }
    }
}
