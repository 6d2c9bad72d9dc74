//! The contact forces of a verdict: numbers side by side. Objects, arrays and text are made when they are asked for.

use crate::{arrays::vector, coordinates::Coordinates, errors::no_forces, watch::interruptible};
use drystone::{
    Contact, Feature,
    canonical::canonical_forces,
    formulate::{Assembly, ContactForce as Force, FrictionCone},
    geometry::Numbers,
    settle::{Settled, canonical_forces_after},
    simulate::ContactImpulse,
};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::{exceptions::PyIndexError, prelude::*, types::PyBytes};
use serde::{Deserialize, Serialize};
use std::{fmt::Write, sync::Arc};

/// The force that body `a` exerts on body `b` at one contact point, in newtons.
#[pyclass(frozen, get_all, module = "drystone._core")]
pub struct ContactForce {
    a: String,
    b: String,
    feature: String,
    at_borders: bool,
    point: Coordinates,
    normal: Coordinates,
    normal_force: f64,
    tangential_force: f64,
    force: Coordinates,
}

impl ContactForce {
    /// The mean force of a step of length `dt`.
    pub fn of_impulse<V: Numbers + Into<Coordinates>>(names: &[&str], contact: &ContactImpulse<V>, dt: f64) -> Self {
        let [a, b] = contact.id.bodies.map(|body| names[body].to_owned());
        let mut force = contact.impulse;
        force.as_mut().iter_mut().for_each(|p| *p /= dt);
        Self {
            a,
            b,
            feature: contact.id.feature.to_string(),
            at_borders: contact.id.feature.at_borders(),
            point: contact.point.into(),
            normal: contact.normal.into(),
            normal_force: contact.along_normal / dt,
            tangential_force: contact.tangential() / dt,
            force: force.into(),
        }
    }
}

/// All of a verdict; see the stub.
#[pyclass(frozen, module = "drystone._core")]
#[derive(Serialize, Deserialize)]
pub struct ContactForces {
    /// Of every body of the scene.
    names: Vec<String>,
    in_plane: bool,
    rows: Vec<Row>,
}

/// One contact point; in the plane z is 0.
#[derive(Serialize, Deserialize)]
struct Row {
    bodies: [u32; 2],
    feature: Feature,
    point: [f64; 3],
    normal: [f64; 3],
    force: [f64; 3],
    normal_force: f64,
    tangential_force: f64,
}

/// The same, when they are asked for: what they are computed from.
#[pyclass(frozen, module = "drystone._core")]
pub struct Forces {
    assembly: Arc<Assembly>,
    cone: FrictionCone,
    of: Of,
}

/// Whose forces.
enum Of {
    Verdict(Box<drystone::Verdict>),
    Settled(Box<Settled>),
}

impl Forces {
    /// Of a verdict with these friction cones.
    pub fn new(assembly: Arc<Assembly>, cone: FrictionCone, verdict: drystone::Verdict) -> Self {
        Self { assembly, cone, of: Of::Verdict(Box::new(verdict)) }
    }

    /// Those after a settlement.
    pub fn after(assembly: Arc<Assembly>, cone: FrictionCone, settled: Settled) -> Self {
        Self { assembly, cone, of: Of::Settled(Box::new(settled)) }
    }

    /// Those that were found.
    fn found(&self) -> &[(Contact, Force)] {
        match &self.of {
            Of::Verdict(verdict) => &verdict.forces,
            Of::Settled(settled) => &settled.forces,
        }
    }
}

#[pymethods]
impl Forces {
    fn canonical(&self, py: Python<'_>) -> PyResult<Option<ContactForces>> {
        let forces = interruptible(py, || match &self.of {
            Of::Verdict(verdict) => canonical_forces(&self.assembly, self.cone, verdict),
            Of::Settled(settled) => canonical_forces_after(&self.assembly, self.cone, settled),
        })?;
        Ok(forces.map(|forces| ContactForces::new(&self.assembly, forces.iter())))
    }

    fn any(&self) -> ContactForces {
        ContactForces::new(&self.assembly, self.found().iter().map(|(_, force)| force))
    }

    fn at_borders(&self) -> bool {
        self.found().iter().any(|(contact, _)| contact.id.feature.at_borders())
    }

    fn __len__(&self) -> usize {
        self.found().len()
    }
}

impl ContactForces {
    pub fn new<'a>(assembly: &Assembly, forces: impl Iterator<Item = &'a Force>) -> Self {
        let row = |force: &Force| {
            let contact = &assembly.contacts()[force.contact];
            Row {
                bodies: contact.bodies.map(|body| body as u32),
                feature: contact.id.feature,
                point: contact.point,
                normal: contact.normal,
                force: force.force,
                normal_force: force.normal,
                tangential_force: force.tangential,
            }
        };
        Self {
            names: assembly.bodies().iter().map(|body| body.name.clone()).collect(),
            in_plane: assembly.in_plane(),
            rows: forces.map(row).collect(),
        }
    }

    fn name(&self, body: u32) -> &str {
        &self.names[body as usize]
    }

    fn array<'py>(&self, py: Python<'py>, of: impl Fn(&Row) -> [f64; 3]) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let dimension = if self.in_plane { 2 } else { 3 };
        let flat: Vec<f64> = self.rows.iter().flat_map(|row| of(row).into_iter().take(dimension)).collect();
        Ok(crate::arrays::read_only(PyArray1::from_vec(py, flat).reshape([self.rows.len(), dimension])?))
    }
}

#[pymethods]
impl ContactForces {
    fn __len__(&self) -> usize {
        self.rows.len()
    }

    /// The force of a contact point by its number.
    fn at(&self, index: usize) -> PyResult<ContactForce> {
        let row = self.rows.get(index).ok_or_else(|| PyIndexError::new_err("there is no such contact point"))?;
        let coordinates = |of| Coordinates::of(of, self.in_plane);
        Ok(ContactForce {
            a: self.name(row.bodies[0]).to_owned(),
            b: self.name(row.bodies[1]).to_owned(),
            feature: row.feature.to_string(),
            at_borders: row.feature.at_borders(),
            point: coordinates(row.point),
            normal: coordinates(row.normal),
            normal_force: row.normal_force,
            tangential_force: row.tangential_force,
            force: coordinates(row.force),
        })
    }

    fn bodies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        let flat = self.rows.iter().flat_map(|row| row.bodies).map(i64::from).collect();
        Ok(crate::arrays::read_only(PyArray1::from_vec(py, flat).reshape([self.rows.len(), 2])?))
    }

    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.array(py, |row| row.point)
    }

    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.array(py, |row| row.normal)
    }

    fn vectors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.array(py, |row| row.force)
    }

    fn normal_forces<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.rows.iter().map(|row| row.normal_force).collect())
    }

    fn tangential_forces<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.rows.iter().map(|row| row.tangential_force).collect())
    }

    /// Numbers of the contact points where only borders meet and that bear.
    fn borders(&self) -> Vec<usize> {
        let bears = |&k: &usize| self.rows[k].feature.at_borders() && self.rows[k].normal_force > 0.0;
        (0..self.rows.len()).filter(bears).collect()
    }

    /// JSON objects of the points from `first` to before `end`, one a line, with commas between them.
    fn json(&self, first: usize, end: usize) -> PyResult<String> {
        let rows =
            self.rows.get(first..end).ok_or_else(|| PyIndexError::new_err("there are no such contact points"))?;
        let mut text = String::with_capacity(320 * rows.len());
        for (k, row) in rows.iter().enumerate() {
            text.push_str(if k > 0 { ",\n" } else { "" });
            self.write_row(&mut text, row);
        }
        Ok(text)
    }

    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &postcard::to_stdvec(self).map_err(no_forces)?))
    }

    /// What `to_bytes` was asked of.
    #[staticmethod]
    fn from_bytes(state: &[u8]) -> PyResult<Self> {
        let read: Self = postcard::from_bytes(state).map_err(no_forces)?;
        let known = |row: &Row| row.bodies.iter().all(|&body| (body as usize) < read.names.len());
        if read.rows.iter().all(known) { Ok(read) } else { Err(no_forces("a body without a name")) }
    }
}

impl ContactForces {
    fn write_row(&self, text: &mut String, row: &Row) {
        let numbers = |of: &[f64; 3]| -> String {
            let dimension = if self.in_plane { 2 } else { 3 };
            of[..dimension].iter().map(|number| format!("{number:?}")).collect::<Vec<_>>().join(", ")
        };
        let [a, b] = row.bodies.map(|body| quoted(self.name(body)));
        let written = write!(
            text,
            "{{\"a\": {a}, \"b\": {b}, \"feature\": \"{}\", \"point\": [{}], \"normal\": [{}], \"normal_force\": {:?}, \
             \"tangential_force\": {:?}, \"force\": [{}], \"at_borders\": {}}}",
            row.feature,
            numbers(&row.point),
            numbers(&row.normal),
            row.normal_force,
            row.tangential_force,
            numbers(&row.force),
            row.feature.at_borders(),
        );
        written.expect("a string takes what is written");
    }
}

/// A JSON string in ASCII.
fn quoted(name: &str) -> String {
    let json = serde_json::to_string(name).expect("a string is JSON");
    let mut ascii = String::with_capacity(json.len());
    for c in json.chars() {
        match c {
            ' '..='~' => ascii.push(c),
            _ => c.encode_utf16(&mut [0; 2]).iter().for_each(|unit| ascii.push_str(&format!("\\u{unit:04x}"))),
        }
    }
    ascii
}
