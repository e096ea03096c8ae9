//! A history for numpy: `numpy.load(file)["u_c_m"]` is the column of that
//! name. An `.npz` is a zip of `.npy` arrays.

use std::io::{Error, Result, Write};

use npyz::WriterBuilder;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::History;

/// Writes a history.
///
/// # Errors
/// An error of the writer.
pub fn write(history: &History, out: &mut dyn Write) -> Result<()> {
    let mut archive = ZipWriter::new_stream(out);
    // A fixed date, so that the same history gives the same file.
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default());
    for column in history.columns() {
        archive.start_file(format!("{}.npy", column.name), options).map_err(Error::other)?;
        archive.write_all(&array(&column.values)?)?;
    }
    archive.finish().map_err(Error::other)?;
    Ok(())
}

/// One array in numpy's format.
fn array(values: &[f64]) -> Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(8 * values.len() + 128);
    let mut writer = npyz::WriteOptions::<f64>::new()
        .default_dtype()
        .shape(&[values.len() as u64])
        .writer(&mut bytes)
        .begin_nd()?;
    writer.extend(values.iter().copied())?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_read_back_as_the_numbers() {
        for count in [0_u32, 1, 9, 10, 12_345] {
            let values: Vec<f64> = (0..count).map(|n| f64::from(n) / 3.0).collect();
            let bytes = array(&values).unwrap();
            let file = npyz::NpyFile::new(bytes.as_slice()).unwrap();
            assert_eq!(file.shape(), [u64::from(count)]);
            assert_eq!(file.into_vec::<f64>().unwrap(), values);
        }
    }
}
