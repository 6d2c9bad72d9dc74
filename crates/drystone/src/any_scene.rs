//! A scene whose dimension is known only when it is there: from a file, by name, or from another language.

use crate::{
    error::SceneError,
    formulate::{Assembly, Cones},
    scene::Scene,
    scene_in_space::SceneInSpace,
};

/// A scene in the plane or in space.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyScene {
    /// Of polygons.
    Plane(Scene),
    /// Of solids.
    Space(SceneInSpace),
}

/// Does the same with either scene.
macro_rules! with_scene {
    ($any:expr, $scene:ident => $answer:expr) => {
        match $any {
            AnyScene::Plane($scene) => $answer,
            AnyScene::Space($scene) => $answer,
        }
    };
}

impl AnyScene {
    /// 2 or 3.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Plane(_) => 2,
            Self::Space(_) => 3,
        }
    }

    /// The contacts and generators; see [`Assembly::with_cones`].
    ///
    /// # Errors
    /// [`SceneError::Overlap`], [`SceneError::BadFacets`].
    pub fn assembly(&self, cones: Cones) -> Result<Assembly, SceneError> {
        with_scene!(self, scene => Assembly::with_cones(scene, cones))
    }

    /// The scene in the plane.
    ///
    /// # Errors
    /// [`SceneError::NotInPlane`].
    pub fn in_plane(self) -> Result<Scene, SceneError> {
        match self {
            Self::Plane(scene) => Ok(scene),
            Self::Space(_) => Err(SceneError::NotInPlane),
        }
    }

    /// The scene in space.
    ///
    /// # Errors
    /// [`SceneError::NotInSpace`].
    pub fn in_space(self) -> Result<SceneInSpace, SceneError> {
        match self {
            Self::Space(scene) => Ok(scene),
            Self::Plane(_) => Err(SceneError::NotInSpace),
        }
    }

    /// Number of bodies.
    pub fn len(&self) -> usize {
        with_scene!(self, scene => scene.bodies().len())
    }

    /// Whether there is no body.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Name of a body.
    pub fn name(&self, index: usize) -> &str {
        with_scene!(self, scene => &scene.bodies()[index].name)
    }

    /// Index of the body with this name.
    ///
    /// # Errors
    /// [`SceneError::UnknownName`].
    pub fn index_of(&self, name: &str) -> Result<usize, SceneError> {
        with_scene!(self, scene => scene.index_of(name))
    }

    /// The coefficient of friction of bodies without one of their own.
    pub fn friction(&self) -> f64 {
        with_scene!(self, scene => scene.friction())
    }

    /// The largest coefficient of friction that any contact can have.
    pub fn largest_friction(&self) -> f64 {
        with_scene!(self, scene => scene.largest_friction())
    }

    /// The one contact tolerance for every pair, metres, if the scene sets it.
    pub fn contact_tolerance(&self) -> Option<f64> {
        with_scene!(self, scene => scene.contact_tolerance())
    }

    /// The text of its file.
    pub fn to_json(&self) -> String {
        with_scene!(self, scene => crate::io::to_json(scene))
    }
}

impl From<Scene> for AnyScene {
    fn from(scene: Scene) -> Self {
        Self::Plane(scene)
    }
}

impl From<SceneInSpace> for AnyScene {
    fn from(scene: SceneInSpace) -> Self {
        Self::Space(scene)
    }
}
