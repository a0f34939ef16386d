//! JSON as people like to read it: what fits on a line stays on it, fields keep their order.

/// Wide enough for a weighted colour of three ranges.
const WIDTH: usize = 112;

/// Lays out compact, valid JSON anew. Two spaces of indent; a list or object whose text fits into
/// the line is not broken, but the outermost one always is. Ends in a line feed.
#[must_use]
pub fn pretty(compact: &str) -> String {
    let mut rest = compact;
    let tree = Node::read(&mut rest);
    let mut text = String::new();
    tree.write(&mut text, 0, 0);
    text.push('\n');
    text
}

/// JSON by its brackets alone; leaves are text.
enum Node<'a> {
    Leaf(&'a str),
    List(Vec<Node<'a>>),
    Object(Vec<(&'a str, Node<'a>)>),
}

impl<'a> Node<'a> {
    /// Takes a value off the front of a text.
    fn read(rest: &mut &'a str) -> Self {
        if take(rest, '[') {
            let mut items = Vec::new();
            while !rest.is_empty() && !take(rest, ']') {
                items.push(Self::read(rest));
                take(rest, ',');
            }
            return Self::List(items);
        }
        if take(rest, '{') {
            let mut fields = Vec::new();
            while !rest.is_empty() && !take(rest, '}') {
                let name = read_leaf(rest);
                take(rest, ':');
                fields.push((name, Self::read(rest)));
                take(rest, ',');
            }
            return Self::Object(fields);
        }
        Self::Leaf(read_leaf(rest))
    }

    /// `taken` is what stands on the line already.
    fn write(&self, text: &mut String, indent: usize, taken: usize) {
        let line = self.inline();
        if indent > 0 && taken + line.len() < WIDTH {
            text.push_str(&line);
            return;
        }
        match self {
            Self::List(items) if !items.is_empty() => {
                text.push('[');
                for (i, item) in items.iter().enumerate() {
                    new_line(text, indent + 1, i > 0);
                    item.write(text, indent + 1, 2 * (indent + 1));
                }
                new_line(text, indent, false);
                text.push(']');
            }
            Self::Object(fields) if !fields.is_empty() => {
                text.push('{');
                for (i, (name, item)) in fields.iter().enumerate() {
                    new_line(text, indent + 1, i > 0);
                    text.push_str(name);
                    text.push_str(": ");
                    item.write(text, indent + 1, 2 * (indent + 1) + name.len() + 2);
                }
                new_line(text, indent, false);
                text.push('}');
            }
            _ => text.push_str(&line),
        }
    }

    fn inline(&self) -> String {
        match self {
            // `2` rather than `2.0`.
            Self::Leaf(leaf) if !leaf.starts_with('"') => {
                leaf.strip_suffix(".0").unwrap_or(leaf).to_owned()
            }
            Self::Leaf(leaf) => (*leaf).to_owned(),
            Self::List(items) => {
                let items: Vec<String> = items.iter().map(Self::inline).collect();
                format!("[{}]", items.join(", "))
            }
            Self::Object(fields) => {
                let field = |(name, item): &(&str, Self)| format!("{name}: {}", item.inline());
                let fields: Vec<String> = fields.iter().map(field).collect();
                format!("{{{}}}", fields.join(", "))
            }
        }
    }
}

fn take(rest: &mut &str, c: char) -> bool {
    match rest.strip_prefix(c) {
        Some(after) => {
            *rest = after;
            true
        }
        None => false,
    }
}

/// Takes a text with its quotes, a number or a word off the front.
fn read_leaf<'a>(rest: &mut &'a str) -> &'a str {
    let (mut quoted, mut escaped) = (false, false);
    let end = rest.char_indices().find(|&(i, c)| {
        let ends =
            if quoted { c == '"' && !escaped } else { i > 0 && matches!(c, ',' | ':' | ']' | '}') };
        escaped = quoted && c == '\\' && !escaped;
        quoted = if i == 0 { c == '"' } else { quoted };
        ends
    });
    let length = match end {
        Some((i, '"')) => i + 1,
        Some((i, _)) => i,
        None => rest.len(),
    };
    let (leaf, after) = rest.split_at(length);
    *rest = after;
    leaf
}

fn new_line(text: &mut String, indent: usize, comma: bool) {
    text.push_str(if comma { ",\n" } else { "\n" });
    text.push_str(&"  ".repeat(indent));
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    #[test]
    fn short_values_stay_on_a_line_in_their_order() {
        let text = pretty(r#"{"z":{"uniform":[-7.5,7.0]},"a":[],"b":{}}"#);
        let expected = "{\n  \"z\": {\"uniform\": [-7.5, 7]},\n  \"a\": [],\n  \"b\": {}\n}\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn nothing_is_lost() {
        let value = json!({
            "quotes \"\\": ["\\", "\"", "a\"b,c]}", "", "\\\\\"", "é☃"],
            "deep": [[[1, -2.5e-7, true, null]], {"x": {"y": "x".repeat(120)}}],
            "long": (0..80).collect::<Vec<i32>>(),
        });
        let text = pretty(&value.to_string());
        assert!(text.lines().count() > 80);
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
    }
}
