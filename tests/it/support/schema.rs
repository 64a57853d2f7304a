//! JSON Schema (2020-12), as much of it as the schemas here use. A keyword that is not
//! known panics: nothing goes unchecked.
//!
//! A crate would bring features of serde_json that the program is built without, and then
//! the tests would run another program.

use regex_lite::Regex;
use serde_json::Value;

/// Words that say nothing about a value.
const REMARKS: [&str; 5] = ["$schema", "$defs", "title", "description", "default"];

/// A schema that describes all there may be.
pub(crate) struct Schema(Value);

impl Schema {
    /// The schema as it stands.
    pub(crate) fn open(schema: Value) -> Schema {
        Schema(schema)
    }

    /// The schema, closed against properties that it does not describe.
    pub(crate) fn closed(mut schema: Value) -> Schema {
        close(&mut schema);
        Schema(schema)
    }

    /// What is wrong with a value, a line each.
    pub(crate) fn problems(&self, value: &Value) -> Vec<String> {
        let mut problems = Vec::new();
        self.check(&self.0, value, "", &mut problems);
        problems
    }

    fn holds(&self, schema: &Value, value: &Value) -> bool {
        let mut problems = Vec::new();
        self.check(schema, value, "", &mut problems);
        problems.is_empty()
    }

    fn check(&self, schema: &Value, value: &Value, at: &str, problems: &mut Vec<String>) {
        for (keyword, rule) in schema.as_object().unwrap_or_else(|| panic!("no schema: {schema}")) {
            match keyword.as_str() {
                remark if REMARKS.contains(&remark) => {}
                "$ref" => {
                    let pointer = rule.as_str().unwrap().strip_prefix('#').unwrap();
                    let target = self.0.pointer(pointer).unwrap_or_else(|| panic!("{rule} leads nowhere"));
                    self.check(target, value, at, problems);
                }
                "properties" | "additionalProperties" | "propertyNames" | "required" => {
                    self.check_object(schema, keyword, value, at, problems);
                }
                "items" => {
                    for (i, item) in value.as_array().into_iter().flatten().enumerate() {
                        self.check(rule, item, &format!("{at}/{i}"), problems);
                    }
                }
                keyword if !self.keeps(keyword, rule, value) => {
                    problems.push(format!("{at}: {value} against {keyword} {rule}"));
                }
                _ => {}
            }
        }
    }

    fn check_object(
        &self,
        schema: &Value,
        keyword: &str,
        value: &Value,
        at: &str,
        problems: &mut Vec<String>,
    ) {
        let Some(members) = value.as_object() else { return };
        let rule = &schema[keyword];
        let described = |name: &str| schema["properties"].get(name).is_some();
        for (name, member) in members {
            let at = format!("{at}/{name}");
            match keyword {
                "properties" if described(name) => self.check(&rule[name], member, &at, problems),
                "additionalProperties" if !described(name) => match rule {
                    Value::Bool(true) => {}
                    Value::Bool(false) => problems.push(format!("{at}: is not described")),
                    rule => self.check(rule, member, &at, problems),
                },
                "propertyNames" => self.check(rule, &name.as_str().into(), &at, problems),
                _ => {}
            }
        }
        if keyword == "required" {
            let missing =
                rule.as_array().unwrap().iter().filter(|name| !members.contains_key(name.as_str().unwrap()));
            problems.extend(missing.map(|name| format!("{at}: lacks {name}")));
        }
    }

    /// Whether a value keeps a rule about itself alone.
    fn keeps(&self, keyword: &str, rule: &Value, value: &Value) -> bool {
        let number = |pass: fn(f64, f64) -> bool| {
            value.as_f64().is_none_or(|number| pass(number, rule.as_f64().unwrap()))
        };
        let length = |pass: fn(usize, usize) -> bool| {
            let rule = rule.as_u64().unwrap() as usize;
            value.as_array().is_none_or(|items| pass(items.len(), rule))
        };
        let alternatives = || rule.as_array().unwrap().iter();
        match keyword {
            "type" if rule.is_array() => alternatives().any(|rule| is_of(value, rule)),
            "type" => is_of(value, rule),
            "const" => value == rule,
            "enum" => alternatives().any(|one| one == value),
            "oneOf" => alternatives().filter(|rule| self.holds(rule, value)).count() == 1,
            "not" => !self.holds(rule, value),
            "pattern" => {
                let pattern = Regex::new(rule.as_str().unwrap()).unwrap();
                value.as_str().is_none_or(|text| pattern.is_match(text))
            }
            "minLength" => {
                value.as_str().is_none_or(|text| text.chars().count() as u64 >= rule.as_u64().unwrap())
            }
            "minimum" => number(|number, least| number >= least),
            "exclusiveMinimum" => number(|number, least| number > least),
            "minItems" => length(|length, least| length >= least),
            "maxItems" => length(|length, most| length <= most),
            unknown => panic!("the keyword {unknown} is not known here"),
        }
    }
}

fn is_of(value: &Value, name: &Value) -> bool {
    match name.as_str().unwrap() {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        unknown => panic!("the type {unknown} is not known"),
    }
}

/// Forbids properties that are not described, in every object.
fn close(schema: &mut Value) {
    match schema {
        Value::Object(members) => {
            if members.contains_key("required") && members.contains_key("properties") {
                members.entry("additionalProperties").or_insert(false.into());
            }
            members.values_mut().for_each(close);
        }
        Value::Array(items) => items.iter_mut().for_each(close),
        _ => {}
    }
}
