//! How a built-in scene describes itself and its parameters.

use crate::any_scene::AnyScene;
use crate::bounds::FRICTION;
use crate::error::SceneError;
use crate::suggest::nearest;
use serde_json::Value;
use std::collections::BTreeMap;

/// A built-in scene in the [`catalogue`](super::catalogue).
#[derive(Debug)]
pub struct SceneEntry {
    /// The name to ask for.
    pub name: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
    /// What can be chosen, in the order of the function's arguments.
    pub parameters: &'static [Parameter],
    pub(super) make: fn(&Arguments) -> Result<AnyScene, SceneError>,
}

/// One parameter of a built-in scene.
#[derive(Debug)]
pub struct Parameter {
    /// The name to give it by.
    pub name: &'static str,
    /// What it is, in one line, with its unit.
    pub summary: &'static str,
    /// Whether it counts or measures.
    pub kind: ParameterKind,
    /// The value without one given.
    pub default: f64,
    /// The least value allowed.
    pub minimum: f64,
    /// The largest value allowed; may be infinite, meaning any finite number.
    pub maximum: f64,
}

/// Whether a parameter counts or measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterKind {
    /// A whole number.
    Integer,
    /// Any finite number.
    Number,
}

/// A parameter that counts.
pub(super) const fn integer(name: &'static str, default: u64, range: [u64; 2], summary: &'static str) -> Parameter {
    let kind = ParameterKind::Integer;
    let [minimum, maximum] = [range[0] as f64, range[1] as f64];
    Parameter { name, summary, kind, default: default as f64, minimum, maximum }
}

/// A parameter that measures.
pub(super) const fn number(name: &'static str, default: f64, range: [f64; 2], summary: &'static str) -> Parameter {
    let [minimum, maximum] = range;
    Parameter { name, summary, kind: ParameterKind::Number, default, minimum, maximum }
}

/// The coefficient of friction of the whole scene.
pub(super) const fn friction(default: f64) -> Parameter {
    number("friction", default, [0.0, FRICTION.most], "coefficient of friction of every block")
}

/// The start of a pseudo-random sequence. Numbers up to 2^53 survive JSON.
pub(super) const fn seed(default: u64, summary: &'static str) -> Parameter {
    integer("seed", default, [0, 1 << 53], summary)
}

/// The values of a scene's parameters, by position.
pub(super) struct Arguments {
    values: Vec<f64>,
}

impl Arguments {
    pub fn integer(&self, position: usize) -> u64 {
        self.values[position] as u64
    }

    pub fn size(&self, position: usize) -> usize {
        self.values[position] as usize
    }

    pub fn number(&self, position: usize) -> f64 {
        self.values[position]
    }
}

impl SceneEntry {
    pub(super) fn build(&self, given: &BTreeMap<String, Value>) -> Result<AnyScene, SceneError> {
        if let Some(unknown) = given.keys().find(|name| self.parameter(name).is_none()) {
            return Err(self.unknown_parameter(unknown));
        }
        let value = |parameter: &Parameter| match given.get(parameter.name) {
            None => Ok(parameter.default),
            Some(value) => self.read(parameter, value),
        };
        let values = self.parameters.iter().map(value).collect::<Result<_, _>>()?;
        (self.make)(&Arguments { values })
    }

    /// Checks that the values lie in the ranges of the parameters, in the same order.
    pub(super) fn check(&self, values: &[f64]) -> Result<(), SceneError> {
        for (parameter, &value) in self.parameters.iter().zip(values) {
            let within = (parameter.minimum..=parameter.maximum).contains(&value);
            if !within || !value.is_finite() {
                return Err(self.refuse(parameter, value.to_string()));
            }
        }
        Ok(())
    }

    fn parameter(&self, name: &str) -> Option<&Parameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }

    /// A number of the right kind; whole ones may be written as 3 or 3.0. The scene's function
    /// checks the range, which also guards callers that do not come by name; a whole number is
    /// checked here as well, before it is cut to an unsigned one.
    fn read(&self, parameter: &Parameter, value: &Value) -> Result<f64, SceneError> {
        let number = value.as_f64().ok_or_else(|| self.refuse(parameter, value.to_string()))?;
        let range = parameter.minimum..=parameter.maximum;
        let whole = number.fract() == 0.0 && range.contains(&number);
        if parameter.kind == ParameterKind::Integer && !whole {
            return Err(self.refuse(parameter, number.to_string()));
        }
        Ok(number)
    }

    fn refuse(&self, parameter: &Parameter, found: String) -> SceneError {
        SceneError::BadParameter {
            scene: self.name.to_owned(),
            parameter: parameter.name.to_owned(),
            found,
            expected: parameter.accepted(),
        }
    }

    fn unknown_parameter(&self, parameter: &str) -> SceneError {
        let names = self.parameters.iter().map(|p| p.name);
        SceneError::UnknownParameter {
            scene: self.name.to_owned(),
            parameter: parameter.to_owned(),
            nearest: nearest(parameter, names.clone()),
            known: names.collect::<Vec<_>>().join(", "),
        }
    }
}

impl Parameter {
    /// In words, what values are accepted.
    pub fn accepted(&self) -> String {
        let kind = match self.kind {
            ParameterKind::Integer => "a whole number",
            ParameterKind::Number => "a number",
        };
        if self.maximum.is_finite() {
            format!("{kind} from {} to {}", self.minimum, self.maximum)
        } else {
            format!("{kind} of at least {}", self.minimum)
        }
    }
}
