"use strict";
// CDR decoder: message definitions of ROS 2 ("ros2msg") as text -> function from bytes to an object. Uses no browser
// function except TextDecoder, so that tests can run it elsewhere.
// Source: ROS 2 interface definition; OMG, DDS-XTypes 1.3, 7.4.1 and 7.4.2 (XCDR1) and 7.6.2.1.2 (encapsulation header).
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});

  // Size in bytes and reading function of each number. 64-bit integers become numbers: exact up to 2^53.
  const kNumbers = {
    bool: [1, (v, at) => v.getUint8(at) !== 0],
    byte: [1, (v, at) => v.getUint8(at)],
    char: [1, (v, at) => v.getUint8(at)],
    uint8: [1, (v, at) => v.getUint8(at)],
    int8: [1, (v, at) => v.getInt8(at)],
    uint16: [2, (v, at, little) => v.getUint16(at, little)],
    int16: [2, (v, at, little) => v.getInt16(at, little)],
    uint32: [4, (v, at, little) => v.getUint32(at, little)],
    int32: [4, (v, at, little) => v.getInt32(at, little)],
    uint64: [8, (v, at, little) => Number(v.getBigUint64(at, little))],
    int64: [8, (v, at, little) => Number(v.getBigInt64(at, little))],
    float32: [4, (v, at, little) => v.getFloat32(at, little)],
    float64: [8, (v, at, little) => v.getFloat64(at, little)],
  };
  const kStamps = ["time", "duration", "builtin_interfaces/Time", "builtin_interfaces/Duration"];
  const kText = new TextDecoder();

  /** "pkg/msg/Name" as "pkg/Name". */
  const short = (name) => name.replace("/msg/", "/");

  /** A line of a definition, {name, type, list, count}, or null for comments and constants. list: "", "fixed" or "any" */
  function fieldOf(line) {
    const words = /^\s*([\w/]+)(?:<=\d+)?(\[(<=)?(\d*)\])?\s+(\w+)\s*(=)?/.exec(line.replace(/#.*$/, ""));
    if (!words || words[6]) return null;
    const list = words[2] === undefined ? "" : words[4] && !words[3] ? "fixed" : "any";
    return { name: words[5], type: words[1], list, count: list === "fixed" ? Number(words[4]) : 0 };
  }

  /** Types by name of a schema's text; the message itself is "". Types of its parts follow behind lines of "=". */
  function typesOf(text) {
    const types = new Map();
    for (const part of text.split(/^={10,}\s*$/m)) {
      const lines = part.trim().split("\n");
      const own = types.size === 0 ? null : /^MSG:\s*(\S+)/.exec(lines[0]);
      if (types.size > 0 && !own) throw new Error("a part of the definition has no name");
      types.set(own ? short(own[1]) : "", (own ? lines.slice(1) : lines).map(fieldOf).filter((field) => field !== null));
    }
    return types;
  }

  /** Position in a message. Numbers are aligned to their size, counted from the end of the encapsulation header. */
  class Cursor {
    constructor(view) {
      const kind = view.getUint8(1);
      if (view.getUint8(0) !== 0 || kind > 1) throw new Error("unknown CDR encapsulation " + kind);
      this.view = view;
      this.little = kind === 1;
      this.at = 4;
    }

    number([size, read]) {
      const at = ((this.at - 4 + size - 1) & ~(size - 1)) + 4;
      this.at = at + size;
      return read(this.view, at, this.little);
    }

    text() {
      const size = this.number(kNumbers.uint32), from = this.view.byteOffset + this.at;
      if (this.at + size > this.view.byteLength) throw new Error("a text ends outside its message");
      this.at += size;
      return size > 1 ? kText.decode(new Uint8Array(this.view.buffer, from, size - 1)) : "";
    }

    /** Length of a list. An element has at least one byte, so that a damaged length cannot fill the memory. */
    length() {
      const length = this.number(kNumbers.uint32);
      if (length > this.view.byteLength - this.at) throw new Error("a list ends outside its message");
      return length;
    }
  }

  /** Function from a cursor to a value of a type. */
  function readerOf(type, scope, types, made) {
    if (kNumbers[type]) return (cursor) => cursor.number(kNumbers[type]);
    if (type === "string") return (cursor) => cursor.text();
    if (kStamps.includes(short(type))) {
      return (cursor) => ({ sec: cursor.number(kNumbers.int32), nanosec: cursor.number(kNumbers.uint32) });
    }
    const name = type === "" ? "" : Live.findType(type, scope, types);
    if (!made.has(name)) {
      const parts = [];
      made.set(name, (cursor) => {
        const message = {};
        for (const [key, read] of parts) message[key] = read(cursor);
        return message;
      });
      for (const field of types.get(name)) parts.push([field.name, listReader(field, readerOf(field.type, name, types, made))]);
    }
    return made.get(name);
  }

  function listReader({ list, count, type }, read) {
    if (list === "") return read;
    return (cursor) => {
      const length = list === "fixed" ? count : cursor.length();
      if (kNumbers[type] && kNumbers[type][0] === 1 && type !== "bool") {  // pictures and grids: no copy, no loop
        const Bytes = type === "int8" ? Int8Array : Uint8Array, from = cursor.view.byteOffset + cursor.at;
        cursor.at += length;
        return new Bytes(cursor.view.buffer, from, length);
      }
      const values = new Array(length);
      for (let i = 0; i < length; ++i) values[i] = read(cursor);
      return values;
    };
  }

  /** Key of a type in a schema's types: with its package, or in the package of the type that uses it. */
  Live.findType = function (type, scope, types) {
    const own = short(type), near = scope.split("/")[0] + "/" + own;
    const found = [own, near, "std_msgs/" + own].find((name) => types.has(name)) ||
      [...types.keys()].find((name) => name.endsWith("/" + own));
    if (!found) throw new Error("the definition lacks type " + type);
    return found;
  };

  /** {types, read(view)} of a schema's text. read() throws if bytes do not fit. @throws Error */
  Live.parseSchema = function (text) {
    const types = typesOf(text), read = readerOf("", "", new Map(types), new Map());
    return { types, read: (view) => read(new Cursor(view)) };
  };
  Live.isNumber = (type) => type in kNumbers;
  Live.isStamp = (type) => kStamps.includes(short(type));
})(typeof window === "undefined" ? globalThis : window);
