//! Coordinate systems as PROJJSON, <https://proj.org/specifications/projjson.html>.

use crate::Place;
use crate::geo::crs::{Crs, Parameter};
use crate::geo::{System, Warnings};
use serde_json::{Value, json};

/// Returns the system of a member `crs`; longitude and latitude if there is none, unknown if it is null.
pub fn system(stated: Option<&Value>, warnings: &mut Warnings) -> System {
    let Some(stated) = stated else { return System::LONLAT };
    if stated.is_null() {
        return System::default();
    }
    let id = if stated["id"].is_null() { &stated["ids"][0] } else { &stated["id"] };
    let code = &id["code"];
    let number = code.as_i64().or_else(|| code.as_str()?.parse().ok());
    let code = match (id["authority"].as_str(), number) {
        (Some("EPSG" | "ESRI"), Some(number)) => i32::try_from(number).ok(),
        (Some("OGC"), _) if code.as_str() == Some("CRS84") => Some(4326),
        _ => None,
    };
    if code.is_none() {
        let name = stated["name"].as_str().unwrap_or("without a name");
        let message = format!("the coordinate system {name} has no number; --from-crs sets one");
        warnings.push(Place::Path("metadata `geo`".to_owned()), message);
    }
    System { code, wkt: None }
}

/// Returns a system; `None` for one that is not known.
pub fn of_system(system: &System) -> Option<Value> {
    Crs::of_system(system).ok().map(|crs| of_crs(&crs))
}

fn of_crs(crs: &Crs) -> Value {
    let ellipsoid = crs.ellipsoid();
    let (frame, name) = crs.names();
    let datum = json!({
        "type": "GeodeticReferenceFrame", "name": frame,
        "ellipsoid": { "name": ellipsoid.name, "semi_major_axis": ellipsoid.a, "inverse_flattening": ellipsoid.inverse },
    });
    let axis = |name: &str, short: &str, direction: &str, unit: Value| json!({ "name": name, "abbreviation": short, "direction": direction, "unit": unit });
    let degrees = [
        axis("Longitude", "lon", "east", json!("degree")),
        axis("Latitude", "lat", "north", json!("degree")),
    ];
    let geographic = json!({
        "type": "GeographicCRS", "name": frame, "datum": datum,
        "coordinate_system": { "subtype": "ellipsoidal", "axis": degrees },
    });
    let mut own = match crs.conversion() {
        None => geographic,
        Some((method, parameters, unit)) => {
            let length = json!({ "type": "LinearUnit", "name": "unit", "conversion_factor": unit });
            let unit = if unit == 1.0 { json!("metre") } else { length };
            let parameter = |parameter: &Parameter| {
                let unit = match parameter.unit {
                    "length" => unit.clone(),
                    other => json!(other),
                };
                json!({ "name": parameter.name, "value": parameter.value, "unit": unit })
            };
            let parameters: Vec<Value> = parameters.iter().map(parameter).collect();
            let axes = [
                axis("Easting", "E", "east", unit.clone()),
                axis("Northing", "N", "north", unit.clone()),
            ];
            json!({
                "type": "ProjectedCRS", "name": name, "base_crs": geographic,
                "conversion": { "name": "unnamed", "method": { "name": method }, "parameters": parameters },
                "coordinate_system": { "subtype": "Cartesian", "axis": axes },
            })
        }
    };
    own["$schema"] = json!("https://proj.org/schemas/v0.7/projjson.schema.json");
    if let Some(code) = crs.code() {
        let authority = if code >= 50_000 { "ESRI" } else { "EPSG" };
        own["id"] = json!({ "authority": authority, "code": code });
    }
    own
}
