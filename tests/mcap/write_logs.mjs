// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Writes one drive as others write MCAP: @mcap/core, with ROS 2's messages by @foxglove/rosmsg2-serialization, chunks
// packed by the command line's lz4 and by zstd's own code.
//
//   node write_logs.mjs FOLDER
//
// cdr_none.mcap cdr_lz4.mcap cdr_zstd.mcap cdr_loose.mcap   joint states (wheel, then column) every 10 ms, stamped in
//     their header, and every 5 ms a torsion bar as a Float64 without; a picture and a message in another encoding
// json.mcap              the same as JSON, without a schema
// shuffled.mcap          cdr_none.mcap with its messages in another order
//
// angle = 0.4 sin(4 t), bar = 2 cos(3 t) with t from FIRST_S; the header's stamp is 2 ms before the recorder's.
import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { McapWriter } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import zstd from "@foxglove/wasm-zstd";

const folder = process.argv[2];
const FIRST_S = 1795613219;
const LINE = "=".repeat(80);
const TIME = "int32 sec\nuint32 nanosec\n";
const HEADER = `builtin_interfaces/Time stamp\nstring frame_id\n`;
const JOINTS = `# joints
std_msgs/Header header
string[] name
float64[] position   # rad
float64[<=4] velocity
float64[] effort
uint8 MODE_FREE=0
bool engaged
int16 gear -1
string<=20 note "none"
${LINE}
MSG: std_msgs/Header
${HEADER}${LINE}
MSG: builtin_interfaces/Time
${TIME}`;
const IMAGE = "uint32 height\nuint8[] data\nfloat32[2] centre\n";
const FLOAT = "float64 data\n";

const messages = [];
const stamp = (ns) => ({ sec: Number(ns / 1_000_000_000n), nanosec: Number(ns % 1_000_000_000n) });
for (let i = 0; i < 600; ++i) {
  const ns = BigInt(FIRST_S) * 1_000_000_000n + BigInt(i) * 5_000_000n;
  const t = i * 0.005;
  messages.push({ topic: "/bar", ns, value: { data: 2 * Math.cos(3 * t) } });
  if (i % 2 == 0) {
    const position = [0.4 * Math.sin(4 * t), -0.4 * Math.sin(4 * t)];
    const value = { header: { stamp: stamp(ns), frame_id: "wheel" }, name: ["wheel", "column"], position, velocity: [],
      effort: [t], engaged: true, gear: -3, note: "n".repeat(i % 7) };
    messages.push({ topic: "/joint_states", ns: ns + 2_000_000n, value });
  }
  if (i % 100 == 0) {
    messages.push({ topic: "/picture", ns, value: { height: 7, data: new Uint8Array(5000), centre: [0.5, 1.5] } });
    messages.push({ topic: "/other", ns, value: {} });
  }
}

class File {
  constructor() {
    this.parts = [];
    this.bytes = 0n;
  }
  position() {
    return this.bytes;
  }
  async write(buffer) {
    this.parts.push(Buffer.from(buffer));
    this.bytes += BigInt(buffer.byteLength);
  }
}

async function write(name, { json = false, compressChunk, useChunks = true, order = (all) => all }) {
  const file = new File();
  const writer = new McapWriter({ writable: file, compressChunk, useChunks, chunkSize: 20_000 });
  await writer.start({ profile: json ? "" : "ros2", library: "a test" });
  const topics = {};
  for (const [topic, type, text] of [["/bar", "std_msgs/msg/Float64", FLOAT],
    ["/joint_states", "sensor_msgs/msg/JointState", JOINTS], ["/picture", "test/msg/Picture", IMAGE]]) {
    const schemaId = json ? 0 : await writer.registerSchema({ name: type, encoding: "ros2msg", data: Buffer.from(text) });
    const id = await writer.registerChannel({ schemaId, topic, messageEncoding: json ? "json" : "cdr", metadata: new Map() });
    const cdr = new MessageWriter(parse(text, { ros2: true }));
    topics[topic] = { id, bytes: json
      ? (value) => Buffer.from(JSON.stringify({ ...value, data: value.data?.length ? [...value.data] : value.data }))
      : (value) => cdr.writeMessage(value) };
  }
  const schemaId = await writer.registerSchema({ name: "other", encoding: "protobuf", data: Buffer.from("x") });
  topics["/other"] = { id: await writer.registerChannel({ schemaId, topic: "/other", messageEncoding: "protobuf",
    metadata: new Map() }), bytes: () => Buffer.from([1, 2]) };
  let sequence = 0;
  for (const { topic, ns, value } of order(messages)) {
    await writer.addMessage({ channelId: topics[topic].id, sequence: sequence++, logTime: ns, publishTime: ns,
      data: topics[topic].bytes(value) });
  }
  await writer.end();
  writeFileSync(join(folder, name), Buffer.concat(file.parts));
}

await zstd.isLoaded;
const lz4 = (bytes) => ({ compression: "lz4", compressedData: execFileSync("lz4", ["-c", "-q"], { input: bytes }) });
await write("cdr_none.mcap", {});
await write("cdr_loose.mcap", { useChunks: false });
await write("cdr_lz4.mcap", { compressChunk: lz4 });
await write("cdr_zstd.mcap", { compressChunk: (bytes) => ({ compression: "zstd", compressedData: zstd.compress(bytes) }) });
await write("json.mcap", { json: true });
await write("shuffled.mcap", { order: (all) => all.map((one, i) => [i * 7919 % all.length, one]).sort((a, b) => a[0] - b[0])
  .map(([, one]) => one) });
