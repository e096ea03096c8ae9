//! A history for numpy: `numpy.load(file)["u_c_m"]` is the column of that
//! name. An `.npz` is a zip of `.npy` arrays. The arrays `version`, `command`
//! and `scene` (a scene file) are texts: `numpy.load(file)["scene"].item()`.

use std::io::{Error, Result, Write};

use npyz::WriterBuilder;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::command::VERSION;
use super::{History, Provenance};

/// Hides the first error of the writer from the archive, which would print it in its own words.
struct Quiet<'a> {
    out: &'a mut dyn Write,
    trouble: Result<()>,
}

impl Write for Quiet<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        if self.trouble.is_ok() {
            self.trouble = self.out.write_all(bytes);
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Writes a history and where it comes from.
///
/// # Errors
/// An error of the writer.
pub fn write(history: &History, origin: &Provenance, out: &mut dyn Write) -> Result<()> {
    let mut quiet = Quiet { out, trouble: Ok(()) };
    let mut archive = ZipWriter::new_stream(&mut quiet);
    // A fixed date, so that the same history gives the same file.
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default());
    let mut add = |name: &str, array: Vec<u8>| {
        archive.start_file(format!("{name}.npy"), options).map_err(Error::other)?;
        archive.write_all(&array)
    };
    for column in history.columns() {
        add(&column.name, array(&column.values)?)?;
    }
    add("version", text(VERSION)?)?;
    add("command", text(&origin.command.to_string())?)?;
    add("scene", text(&origin.scene.to_toml())?)?;
    archive.finish().map_err(Error::other)?;
    quiet.trouble
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

/// A text as numpy's Unicode scalar: an array without dimensions.
fn text(text: &str) -> Result<Vec<u8>> {
    let length = text.chars().count();
    let kind = format!("<U{length}").parse().map_err(Error::other)?;
    let mut bytes = Vec::with_capacity(4 * length + 128);
    let mut writer = npyz::WriteOptions::<str>::new()
        .dtype(npyz::DType::Plain(kind))
        .shape(&[])
        .writer(&mut bytes)
        .begin_nd()?;
    writer.push(text)?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk with room for so many bytes.
    struct Disk(usize);

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> Result<usize> {
            let Some(room) = self.0.checked_sub(bytes.len()) else {
                return Err(Error::new(std::io::ErrorKind::StorageFull, "the disk is full"));
            };
            self.0 = room;
            Ok(bytes.len())
        }

        fn flush(&mut self) -> Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_is_told_in_the_words_of_the_disk_wherever_it_comes() {
        let scene = rubscope_solver::scene::Scene::base();
        let command = crate::report::CommandLine::new("run", &scene);
        let (history, origin) = (History::new(0), Provenance { command, scene });
        let room = |room| write(&history, &origin, &mut Disk(room));
        let enough = (0..).step_by(1000).find(|bytes| room(*bytes).is_ok()).unwrap();
        assert!(enough > 5000);
        for bytes in (0..enough - 1000).step_by(7) {
            assert_eq!(room(bytes).unwrap_err().to_string(), "the disk is full", "{bytes}");
        }
    }

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

    #[test]
    fn a_text_reads_back_as_it_is() {
        for words in ["", "rubscope run", "schema = 1\ntitle = \"Ω\"\n"] {
            let bytes = text(words).unwrap();
            let file = npyz::NpyFile::new(bytes.as_slice()).unwrap();
            assert_eq!(file.shape(), [0_u64; 0]);
            assert_eq!(file.into_vec::<String>().unwrap(), [words]);
        }
    }
}
