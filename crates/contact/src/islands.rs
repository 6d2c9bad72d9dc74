//! Islands: chunks that contacts connect. Nothing passes from one to another, so each is solved alone.

use crate::system::System;

/// Contacts and chunks of every island that has a contact, both in order; islands by their first chunk.
pub(crate) fn islands<const B: usize, const D: usize>(system: &System<B, D>) -> Vec<(Vec<usize>, Vec<usize>)> {
    let mut parent: Vec<u32> = (0..system.free.len() as u32).collect();
    for k in 0..system.len() {
        let chunks = &system.chunks[system.sides(k)];
        for pair in chunks.windows(2) {
            let (a, b) = (root(&mut parent, pair[0]), root(&mut parent, pair[1]));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    let mut number = vec![u32::MAX; parent.len()];
    let mut found: Vec<(Vec<usize>, Vec<usize>)> = Vec::new();
    for k in 0..system.len() {
        let Some(&chunk) = system.chunks[system.sides(k)].first() else { continue };
        let root = root(&mut parent, chunk) as usize;
        if number[root] == u32::MAX {
            number[root] = found.len() as u32;
            found.push((Vec::new(), Vec::new()));
        }
        found[number[root] as usize].0.push(k);
    }
    for chunk in 0..parent.len() {
        let root = root(&mut parent, chunk as u32) as usize;
        if number[root] != u32::MAX {
            found[number[root] as usize].1.push(chunk);
        }
    }
    found
}

fn root(parent: &mut [u32], mut chunk: u32) -> u32 {
    while parent[chunk as usize] != chunk {
        let next = parent[chunk as usize];
        parent[chunk as usize] = parent[next as usize];
        chunk = next;
    }
    chunk
}
