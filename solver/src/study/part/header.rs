//! The first line of a part: everything that determines the cells, and title and
//! note of the scene for readers.

use serde::{Deserialize, Serialize};

use crate::scene::Scene;
use crate::study::{Axis, AxisError, MapPlan};

/// Version of the format and of the numbers in it.
const SCHEMA: &str = "rubscope.map-part/2";
/// The version of the program; another one may judge a motion in another way.
pub(super) const VERSION: &str = env!("CARGO_PKG_VERSION");
/// What comes before the checksum, which is the last field of the line.
const CHECKSUM: &str = ",\"crc32\":\"";

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    schema: String,
    version: String,
    scene: String,
    x: Axis,
    y: Axis,
    sensitivity: bool,
}

/// The schema and the version alone, so that they are named also where the rest
/// has another form.
#[derive(Deserialize)]
struct Written {
    schema: String,
    version: String,
}

/// The header line of a plan, without an end of line, and its checksum, which the
/// cells need.
pub(super) fn line_of(plan: &MapPlan) -> serde_json::Result<(String, u32)> {
    let header = Header {
        schema: SCHEMA.to_string(),
        version: VERSION.to_string(),
        scene: plan.scene.to_toml(),
        x: plan.x.clone(),
        y: plan.y.clone(),
        sensitivity: plan.sensitivity,
    };
    let mut text = serde_json::to_string(&header)?;
    let _ = text.pop(); // The brace comes after the checksum.
    let checksum = crc32fast::hash(text.as_bytes());
    Ok((format!("{text}{CHECKSUM}{checksum:08x}\"}}"), checksum))
}

/// Why a header is no header of a part.
pub(super) enum Fault {
    /// It comes from this other version of the program.
    Version(String),
    /// Something else.
    Form(String),
}

impl From<AxisError> for Fault {
    fn from(error: AxisError) -> Self {
        Self::Form(error.to_string())
    }
}

/// The plan that a header line describes, completely checked, and its checksum.
pub(super) fn read(line: &str) -> Result<(MapPlan, u32), Fault> {
    let form = |error: serde_json::Error| Fault::Form(error.to_string());
    let Written { schema, version } = serde_json::from_str(line).map_err(form)?;
    if schema != SCHEMA {
        return Err(Fault::Form(format!("schema {schema} where {SCHEMA} is read")));
    }
    if version != VERSION {
        return Err(Fault::Version(version));
    }
    let (text, checksum) = checked(line)
        .ok_or_else(|| Fault::Form("its first line does not agree with its checksum".into()))?;
    let header: Header = serde_json::from_str(&format!("{text}}}")).map_err(form)?;
    let again = |axis: &Axis| Axis::new(&axis.path, axis.from, axis.to, axis.count, axis.log);
    let plan = MapPlan {
        scene: Scene::from_toml_unchecked(&header.scene).map_err(AxisError::from)?,
        x: again(&header.x)?,
        y: again(&header.y)?,
        sensitivity: header.sensitivity,
    };
    plan.check().map_err(AxisError::from)?;
    Ok((plan, checksum))
}

/// The text before the checksum, and the checksum if it is that of the text.
fn checked(line: &str) -> Option<(&str, u32)> {
    let (text, rest) = line.rsplit_once(CHECKSUM)?;
    let checksum = super::parse_checksum(rest.strip_suffix("\"}")?)?;
    (crc32fast::hash(text.as_bytes()) == checksum).then_some((text, checksum))
}
