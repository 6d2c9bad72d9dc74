//! Which rows of a contact had forces: where a solve by Lemke's method starts in the next step.

use crate::contact::ContactId;
use serde::{Deserialize, Serialize};

/// The rows with forces of each contact whose island was solved by Lemke's method, in the order of identities.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ActiveRows(Vec<(ContactId, Vec<bool>)>);

impl ActiveRows {
    pub fn add(&mut self, contacts: impl IntoIterator<Item = (ContactId, Vec<bool>)>) {
        self.0.extend(contacts);
        self.0.sort_by_key(|(id, _)| *id);
    }

    pub fn of(&self, id: ContactId) -> Option<&[bool]> {
        let place = self.0.binary_search_by_key(&id, |(id, _)| *id).ok()?;
        Some(&self.0[place].1)
    }
}
