"use strict";
// Connection to a run: a client of the Foxglove WebSocket protocol (github.com/foxglove/ws-protocol, docs/spec.md) that
// subscribes to what is wanted, calls services, sets parameters, publishes, and connects again when the server is gone.
(function (root) {
  const Live = (root.VinerowLive = root.VinerowLive || {});

  const kProtocols = ["foxglove.websocket.v1", "foxglove.sdk.v1"];
  const kRetry_ms = 1000, kAnswer_ms = 10000;
  const kFromServer = { message: 1, time: 2, answer: 3 }, kToServer = { message: 1, call: 2 };
  const kText = new TextDecoder(), kBytes = new TextEncoder();

  const seconds = (view, at) => Number(view.getBigUint64(at, true)) * 1e-9;

  class Socket extends EventTarget {
    /**
     * Events: "state" (connecting, open, closed), "session" ({first, same_connection}), "channels", "services", "time" (s),
     * "parameters" (names), "status" ({level, message, id}), "unstatus" (ids), "malformed" (a frame that is ignored).
     */
    constructor(url) {
      super();
      this.url = url;
      this.state = "closed";
      this.parameters = {};
      this.wishes = new Map();  // handlers by topic: Set of functions (message, time, channel)
      this.schemas = new Map();  // parsed schemas by their text
      this.malformed = 0;
      this.session = null;
      this.next = 1;  // number of the next subscription, call or client channel
      this.forget();
    }

    /** Forgets everything that belongs to a connection or session. */
    forget() {
      this.channels = new Map();  // by topic
      this.services = new Map();  // by name
      this.subscriptions = new Map();  // by number: channel
      this.publications = new Map();  // by topic: number
      for (const call of (this.calls || new Map()).values()) call.reject(new Error("the connection to the run is lost"));
      this.calls = new Map();
    }

    emit(kind, detail) {
      this.dispatchEvent(new CustomEvent(kind, { detail }));
    }

    setState(state) {
      if (state === this.state) return;
      this.state = state;
      this.emit("state", state);
    }

    connect() {
      if (this.state !== "closed") return;
      this.setState("connecting");
      let socket;
      try {
        socket = new WebSocket(this.url, kProtocols);
      } catch (error) {
        this.retry();
        return;
      }
      this.socket = socket;
      socket.binaryType = "arraybuffer";
      socket.onopen = () => this.setState("open");
      socket.onmessage = (event) => {
        if (socket === this.socket) this.receive(event.data);
      };
      socket.onclose = () => {
        if (socket === this.socket) this.retry();
      };
    }

    retry() {
      this.socket = null;
      this.forget();
      this.setState("closed");
      this.emit("channels");
      window.setTimeout(() => this.connect(), kRetry_ms);
    }

    /** One frame. A frame that cannot be read changes nothing. */
    receive(data) {
      try {
        if (typeof data === "string") this.receiveText(JSON.parse(data));
        else this.receiveBytes(new DataView(data));
      } catch (error) {
        ++this.malformed;
        this.emit("malformed", error);
      }
    }

    receiveBytes(view) {
      const kind = view.getUint8(0);
      if (kind === kFromServer.message) {
        const channel = this.subscriptions.get(view.getUint32(1, true));
        // Messages of a subscription that has just ended are still on their way.
        if (!channel || !this.wishes.has(channel.topic)) return;
        const t = seconds(view, 5);
        const message = this.schemaOf(channel).read(new DataView(view.buffer, view.byteOffset + 13));
        for (const handler of this.wishes.get(channel.topic)) handler(message, t, channel);
      } else if (kind === kFromServer.time) {
        this.emit("time", seconds(view, 1));
      } else if (kind === kFromServer.answer) {
        const call = this.calls.get(view.getUint32(5, true)), from = 13 + view.getUint32(9, true);
        this.calls.delete(view.getUint32(5, true));
        if (call) call.resolve(JSON.parse(kText.decode(new Uint8Array(view.buffer, view.byteOffset + from)) || "{}"));
      } else {
        throw new Error("unknown binary frame " + kind);
      }
    }

    receiveText(message) {
      const actions = {
        serverInfo: () => this.receiveInfo(message),
        advertise: () => this.addChannels(message.channels),
        unadvertise: () => this.removeChannels(new Set(message.channelIds)),
        advertiseServices: () => {
          for (const service of message.services) this.services.set(service.name, service);
          this.emit("services");
        },
        unadvertiseServices: () => {
          for (const [name, service] of this.services) if (message.serviceIds.includes(service.id)) this.services.delete(name);
          this.emit("services");
        },
        parameterValues: () => {
          for (const { name, value } of message.parameters) if (typeof name === "string") this.parameters[name] = value;
          this.emit("parameters", message.parameters.map((parameter) => parameter.name));
        },
        status: () => this.emit("status", { level: message.level, message: String(message.message), id: message.id }),
        removeStatus: () => this.emit("unstatus", message.statusIds),
        serviceCallFailure: () => {
          const call = this.calls.get(message.callId);
          this.calls.delete(message.callId);
          if (call) call.reject(new Error(String(message.message)));
        },
        connectionGraphUpdate: () => {},
      };
      if (!Object.prototype.hasOwnProperty.call(actions, message.op)) throw new Error("unknown operation " + message.op);
      actions[message.op]();
    }

    receiveInfo(info) {
      const first = this.session === null, isNew = info.sessionId !== this.session;
      this.session = info.sessionId === undefined ? "" : info.sessionId;
      this.capabilities = info.capabilities || [];
      const isSame = this.greeted === this.socket;
      this.greeted = this.socket;
      if (isNew && isSame) {
        // Channels and subscriptions end with their session, even if the next one uses the same numbers.
        this.channels.clear();
        this.subscriptions.clear();
      }
      if (isNew) this.emit("session", { first, same_connection: isSame });
      if (this.parameterNames && (isNew || !isSame)) {
        this.send({ op: "getParameters", parameterNames: this.parameterNames, id: "all" });
        if (!isSame) this.send({ op: "subscribeParameterUpdates", parameterNames: this.parameterNames });
      }
    }

    addChannels(channels) {
      for (const channel of channels) {
        if (typeof channel.topic !== "string") throw new Error("a channel has no topic");
        // A channel that is advertised again is a new one.
        for (const [number, old] of this.subscriptions) if (old.topic === channel.topic) this.subscriptions.delete(number);
        this.channels.set(channel.topic, channel);
      }
      this.subscribe();
      this.emit("channels");
    }

    removeChannels(ids) {
      for (const [topic, channel] of this.channels) if (ids.has(channel.id)) this.channels.delete(topic);
      for (const [number, channel] of this.subscriptions) if (ids.has(channel.id)) this.subscriptions.delete(number);
      this.emit("channels");
    }

    /** Parsed definition of a channel's messages. @throws Error if it cannot be read */
    schemaOf(channel) {
      if (channel.encoding !== "cdr" || channel.schemaEncoding !== "ros2msg") throw new Error(channel.topic + " is not in CDR");
      if (!this.schemas.has(channel.schema)) this.schemas.set(channel.schema, Live.parseSchema(channel.schema));
      return this.schemas.get(channel.schema);
    }

    /** Calls a handler for each message of a topic, as soon as it exists. @returns function that ends this */
    want(topic, handler) {
      if (!this.wishes.has(topic)) this.wishes.set(topic, new Set());
      this.wishes.get(topic).add(handler);
      this.subscribe();
      return () => {
        const handlers = this.wishes.get(topic);
        if (!handlers || !handlers.delete(handler) || handlers.size > 0) return;
        this.wishes.delete(topic);
        this.unsubscribe();
      };
    }

    subscribe() {
      const held = new Set([...this.subscriptions.values()].map((channel) => channel.topic)), subscriptions = [];
      for (const topic of this.wishes.keys()) {
        const channel = this.channels.get(topic);
        if (!channel || held.has(topic)) continue;
        this.subscriptions.set(this.next, channel);
        subscriptions.push({ id: this.next++, channelId: channel.id });
      }
      if (subscriptions.length > 0) this.send({ op: "subscribe", subscriptions });
    }

    unsubscribe() {
      const subscriptionIds = [];
      for (const [number, channel] of this.subscriptions) if (!this.wishes.has(channel.topic)) subscriptionIds.push(number);
      for (const number of subscriptionIds) this.subscriptions.delete(number);
      if (subscriptionIds.length > 0) this.send({ op: "unsubscribe", subscriptionIds });
    }

    send(message) {
      if (this.state === "open") this.socket.send(typeof message === "object" && message.op ? JSON.stringify(message) : message);
    }

    setParameter(name, value) {
      this.send({ op: "setParameters", parameters: [{ name, value }] });
    }

    /** Answer of a service, as an object. Rejects with a sentence. */
    call(name, request) {
      const service = this.services.get(name);
      if (this.state !== "open") return Promise.reject(new Error("there is no connection to the run"));
      if (!service) return Promise.reject(new Error("the run has no service " + name));
      const encoding = kBytes.encode("json"), payload = kBytes.encode(JSON.stringify(request));
      const bytes = new Uint8Array(13 + encoding.length + payload.length), view = new DataView(bytes.buffer), id = this.next++;
      view.setUint8(0, kToServer.call);
      view.setUint32(1, service.id, true);
      view.setUint32(5, id, true);
      view.setUint32(9, encoding.length, true);
      bytes.set(encoding, 13);
      bytes.set(payload, 13 + encoding.length);
      return new Promise((resolve, reject) => {
        this.calls.set(id, { resolve, reject });
        window.setTimeout(() => {
          if (this.calls.delete(id)) reject(new Error("no answer from " + name));
        }, kAnswer_ms);
        this.send(bytes);
      });
    }

    /** Publishes a message in JSON. @param type  "geometry_msgs/msg/TwistStamped" */
    publish(topic, type, message) {
      if (this.state !== "open") return;
      if (!this.publications.has(topic)) {
        this.publications.set(topic, this.next);
        this.send({ op: "advertise", channels: [{ id: this.next++, topic, encoding: "json", schemaName: type }] });
      }
      const payload = kBytes.encode(JSON.stringify(message)), bytes = new Uint8Array(5 + payload.length);
      bytes[0] = kToServer.message;
      new DataView(bytes.buffer).setUint32(1, this.publications.get(topic), true);
      bytes.set(payload, 5);
      this.send(bytes);
    }

    /** Ends a publication, so that the server knows that nobody drives any more. */
    unpublish(topic) {
      if (this.publications.has(topic)) this.send({ op: "unadvertise", channelIds: [this.publications.get(topic)] });
      this.publications.delete(topic);
    }
  }
  Live.Socket = Socket;
})(window);
