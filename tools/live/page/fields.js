"use strict";
// Numeric fields of messages: their list for choosing, and reading one by its path, "pose.pose.position.x", "value[3]".
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});

  const kElements = 64;  // of a list that are offered
  const kFields = 2000;  // of a message

  const isBytesOrList = (value) => Array.isArray(value) || ArrayBuffer.isView(value);

  /** Name of an element: its own, or that in the list "name" beside its list, as NamedValues and JointState have. */
  function nameOf(message, list, i) {
    const own = list[i];
    if (own && typeof own === "object") return own.child_frame_id || own.name || "";
    return Array.isArray(message.name) && message.name.length === list.length ? String(message.name[i]) : "";
  }

  /**
   * Numeric fields of a schema as [{path, label}]; stamps come last, as they are seldom wanted.
   * @param message a message, which gives the lengths of lists and the names of their elements; null: none yet
   */
  Live.listFields = function (schema, message) {
    const fields = [], stamps = [];
    const add = (type, scope, path, label, value, inStamp) => {
      if (fields.length + stamps.length >= kFields) return;
      if (Live.isNumber(type)) {
        (inStamp ? stamps : fields).push({ path, label });
      } else if (Live.isStamp(type)) {
        for (const part of ["sec", "nanosec"]) stamps.push({ path: path + "." + part, label: label + "." + part });
      } else if (type !== "string" && type !== "wstring") {
        walk(Live.findType(type, scope, schema.types), path, label, value);
      }
    };
    const walk = (name, path, label, value) => {
      for (const field of schema.types.get(name)) {
        const own = (path ? path + "." : "") + field.name, words = (label ? label + "." : "") + field.name;
        const part = value ? value[field.name] : undefined;
        if (field.list === "") {
          add(field.type, name, own, words, part, false);
          continue;
        }
        const length = isBytesOrList(part) ? part.length : field.count;
        for (let i = 0; i < Math.min(length, kElements); ++i) {
          const said = part ? nameOf(value, part, i) : "";
          add(field.type, name, own + "[" + i + "]", words + "[" + i + "]" + (said ? " " + said : ""), part ? part[i] : undefined, false);
        }
      }
    };
    walk("", "", "", message);
    return fields.concat(stamps);
  };

  /** Function that reads a field of a message: a number, or NaN if the message lacks it. */
  Live.fieldReader = function (path) {
    const keys = path.split(/[.[\]]+/).filter((key) => key !== "");
    return (message) => {
      let value = message;
      for (const key of keys) {
        if (value === undefined || value === null) return NaN;
        value = value[key];
      }
      return typeof value === "number" ? value : typeof value === "boolean" ? Number(value) : NaN;
    };
  };
})(typeof window === "undefined" ? globalThis : window);
