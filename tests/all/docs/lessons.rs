//! The lessons on paper: every question, and the answers at the end, made from the lessons
//! of the program.

use rubscope::sheet::number::with_speeds;
use rubscope::tui::lessons::{LETTERS, Lesson, LessonStep, all};

/// Longest line of a document.
const MOST: usize = 120;

/// The lessons with their durations: the rows of a table.
pub fn course() -> Vec<Vec<String>> {
    let row = |(place, lesson): (usize, &Lesson)| {
        let minutes = lesson.minutes().to_string();
        vec![place.to_string(), lesson.title.clone(), minutes, lesson.needs.clone()]
    };
    (1..).zip(all()).map(row).collect()
}

/// The text of `docs/lessons.md` between its comments.
pub fn sheet() -> String {
    let mut out = String::new();
    let mut paragraph = |text: &str, indent: &str| {
        out.push_str(&wrapped(text, indent));
        out.push('\n');
    };
    for (place, lesson) in all().iter().enumerate() {
        paragraph(&format!("## {}. {}", place + 1, lesson.title), "");
        for (number, step) in (1..).zip(&lesson.steps) {
            paragraph(&format!("**{}.{number}** {}", place + 1, step.text), "");
            if let Some(question) = &step.question {
                paragraph(question, "");
                let answers = LETTERS.iter().zip(&step.answers);
                let answers = answers.map(|(letter, text)| format!("**{letter}** {text}"));
                paragraph(&answers.collect::<Vec<_>>().join("; "), "");
            }
            if let Some(task) = &step.task {
                paragraph(&format!("**Task.** {task}"), "");
            }
        }
    }
    paragraph("## Answers", "");
    for (place, lesson) in all().iter().enumerate() {
        let answers: String = answers(place, lesson);
        paragraph(answers.trim_end_matches('\n'), "- ");
    }
    out.trim_end().to_string() + "\n"
}

fn answers(place: usize, lesson: &Lesson) -> String {
    let steps = (1..).zip(&lesson.steps);
    let of = |(number, step): (usize, &LessonStep)| {
        let (right, reason) = (step.right?, step.reason.as_deref()?);
        Some(wrapped(&format!("- **{}.{number}: {right}.** {reason}", place + 1), "  "))
    };
    steps.filter_map(of).collect()
}

/// A text in lines; a list, whose lines begin so, stays as it is.
fn wrapped(text: &str, indent: &str) -> String {
    if indent == "- " {
        return format!("{text}\n");
    }
    let mut lines = vec![String::new()];
    for word in with_speeds(text).split_whitespace() {
        let last = lines.last_mut().unwrap();
        let room = last.chars().count() + 1 + word.chars().count() <= MOST;
        match (last.is_empty(), room) {
            (true, _) => last.push_str(word),
            (false, true) => *last = format!("{last} {word}"),
            (false, false) => lines.push(format!("{indent}{word}")),
        }
    }
    lines.join("\n") + "\n"
}
