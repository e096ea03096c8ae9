//! Links between the documents: the file is there, and so is the heading.

use super::{Document, documents, read, top};

/// The name that a heading has in links: letters, digits, `-` and `_` of it,
/// with `-` for spaces, as on GitHub.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase();
    let kept = kept.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

fn anchors(document: &Document) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for (_, line) in document.prose() {
        let Some(heading) = line.strip_prefix('#') else { continue };
        let name = anchor(heading.trim_start_matches('#'));
        // The second of one name is numbered.
        let before = found.iter().filter(|known| **known == name).count();
        found.push(if before == 0 { name } else { format!("{name}-{before}") });
    }
    found
}

/// What the links of a line lead to; code is no link.
fn targets(line: &str) -> Vec<String> {
    let prose: String = line.split('`').step_by(2).collect::<Vec<_>>().join("code");
    let quoted = ["src=\"", "srcset=\""].map(|start| prose.split(start).skip(1));
    let pictures = quoted.into_iter().flatten().filter_map(|rest| rest.split_once('"'));
    let after = prose.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
    after.chain(pictures).map(|(target, _)| target.to_string()).collect()
}

#[test]
fn every_link_leads_to_a_file_and_a_heading() {
    let mut wrong = Vec::new();
    let mut documents = documents();
    documents.extend(["CHANGELOG.md", "SECURITY.md"].map(read));
    for document in &documents {
        let folder = top().join(&document.name).parent().unwrap().to_path_buf();
        for (number, line) in document.prose() {
            for target in targets(line) {
                if target.starts_with("https://") || target.starts_with("mailto:") {
                    continue;
                }
                let (file, heading) = target.split_once('#').unwrap_or((&target, ""));
                let path =
                    if file.is_empty() { top().join(&document.name) } else { folder.join(file) };
                let known = match std::fs::read_to_string(&path) {
                    Ok(text) if !heading.is_empty() => {
                        let there = Document { name: target.clone(), text };
                        anchors(&there).iter().any(|known| known == heading)
                    }
                    _ => path.exists() && heading.is_empty(),
                };
                if !known {
                    wrong.push(format!("{}:{number}: {target}", document.name));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "links that lead nowhere:\n{}", wrong.join("\n"));
}
