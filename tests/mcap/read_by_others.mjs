// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The MCAP that the command writes, read by @mcap/core with every checksum held, its ROS 2 messages by
// @foxglove/rosmsg2-serialization: each holds what the CSV file of the same run does.
//
//   node read_by_others.mjs STEERID
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import zstd from "@foxglove/wasm-zstd";

const folder = mkdtempSync(join(tmpdir(), "steerid_mcap_"));
const steerid = (...words) => execFileSync(process.argv[2], [...words, "--quiet"], { cwd: folder });
const decompressHandlers = { zstd: (bytes, size) => zstd.decompress(bytes, Number(size)) };

function decoder(schema, channel) {
  const text = Buffer.from(schema.data).toString();
  if (channel.messageEncoding == "json") {
    const properties = Object.keys(JSON.parse(text).properties);
    return (data) => {
      const message = JSON.parse(Buffer.from(data).toString());
      for (const key of Object.keys(message)) assert.ok(properties.includes(key), `${key} is in the schema`);
      return message;
    };
  }
  const reader = new MessageReader(parse(text, { ros2: true }));
  return (data) => reader.readMessage(data);
}

/// By the index, in order of the stamps; and by the stream, with every checksum held.
async function read(name) {
  const bytes = readFileSync(join(folder, name));
  const readable = { size: async () => BigInt(bytes.length),
    read: async (at, count) => bytes.subarray(Number(at), Number(at + count)) };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  assert.equal(reader.channelsById.size, 1);
  const [channel] = reader.channelsById.values();
  const decode = decoder(reader.schemasById.get(channel.schemaId), channel);
  const rows = [];
  for await (const message of reader.readMessages()) rows.push({ ns: message.logTime, ...decode(message.data) });
  assert.equal(BigInt(rows.length), reader.statistics.messageCount);
  assert.equal(rows[0].ns, reader.statistics.messageStartTime);
  assert.equal(rows.at(-1).ns, reader.statistics.messageEndTime);
  const stream = new McapStreamReader({ validateCrcs: true, decompressHandlers, includeChunks: true });
  stream.append(bytes);
  const kinds = {};
  for (let record; (record = stream.nextRecord());) kinds[record.type] = (kinds[record.type] ?? 0) + 1;
  assert.ok(stream.done());
  assert.equal(kinds.Message, rows.length);
  const metadata = [];
  for await (const one of reader.readMetadata()) metadata.push(one);
  return { topic: channel.topic, rows, metadata, chunks: kinds.Chunk, profile: reader.header.profile };
}

function csv(name) {
  const lines = readFileSync(join(folder, name), "utf8").split("\n").filter((line) => line && !line.startsWith("#"));
  const columns = lines[0].split(",");
  return { columns, rows: lines.slice(1).map((line) => line.split(",")) };
}

function same({ rows, topic, profile }, table, name) {
  assert.equal(rows.length, table.rows.length, name);
  rows.forEach((row, i) => {
    assert.equal(Number(row.ns), Math.round(Number(table.rows[i][0]) * 1e9), `${name}: the stamp of row ${i}`);
    table.columns.forEach((column, j) => {
      const cell = table.rows[i][j];
      if (cell === "") assert.ok(row[column] === undefined || Number.isNaN(row[column]), `${name}: nothing in ${column}`);
      else if (typeof row[column] == "string") assert.equal(row[column], cell);
      else assert.equal(row[column], Number(cell), `${name}: ${column} of row ${i}`);
    });
  });
  console.log(`${name}: ${rows.length} messages of ${topic}, profile "${profile}"`);
}

await zstd.isLoaded;
try {
  const drive = ["simulate", "--task", "drive", "--duration", "400", "--seed", "3"];
  steerid(...drive, "--out", "drive.csv", "--truth", "truth.csv");
  steerid(...drive, "--out", "cdr.mcap", "--truth", "truth.mcap");
  steerid(...drive, "--out", "json.mcap", "--mcap-messages", "json");
  const cdr = await read("cdr.mcap");
  assert.equal(cdr.topic, "/steerid/record");
  assert.equal(cdr.profile, "ros2");
  assert.ok(cdr.chunks > 1, "more than one chunk");
  assert.match(cdr.metadata[0].metadata.get("comment"), /simulated {2}drive/);
  same(cdr, csv("drive.csv"), "cdr.mcap");
  same(await read("json.mcap"), csv("drive.csv"), "json.mcap");
  same(await read("truth.mcap"), csv("truth.csv"), "truth.mcap");

  // What is identified from either is the same, and so is the trace.
  for (const [log, trace, words] of [["drive.csv", "t.csv", []], ["cdr.mcap", "t.mcap", []],
    ["json.mcap", "tj.mcap", ["--mcap-messages", "json"]]]) {
    steerid("identify", log, "--json", `${trace}.json`, "--trace", trace, "--layout", `${trace}.xml`, ...words);
  }
  const answer = (name) => {
    const { input, options, notes, ...rest } = JSON.parse(readFileSync(join(folder, name), "utf8"));
    return rest;
  };
  assert.deepEqual(answer("t.mcap.json"), answer("t.csv.json"));
  assert.deepEqual(answer("tj.mcap.json"), answer("t.csv.json"));
  const trace = csv("t.csv");
  const estimate = await read("t.mcap");
  same(estimate, trace, "t.mcap");
  same(await read("tj.mcap"), trace, "tj.mcap");

  // Each curve of a layout is a column of the file that it opens; PlotJuggler calls a message's field TOPIC/FIELD.
  for (const [layout, names] of [["t.csv.xml", trace.columns], ["t.mcap.xml",
    Object.keys(estimate.rows[0]).map((field) => `${estimate.topic}/${field}`)]]) {
    const text = readFileSync(join(folder, layout), "utf8");
    const curves = [...text.matchAll(/<curve name="([^"]*)"/g)].map(([, name]) => name);
    assert.equal(curves.length, 9);
    for (const curve of curves) assert.ok(names.includes(curve), `${curve} of ${layout}`);
    assert.ok(text.includes(`filename="${layout.replace(".xml", "")}"`));
  }
  // The band holds the value, and is 1.96 standard deviations wide to either side.
  const at = (row, column) => Number(row[trace.columns.indexOf(column)]);
  for (const row of trace.rows.filter((_, i) => i % 100 == 0)) {
    const half = (at(row, "inertia_high_kgm2") - at(row, "inertia_low_kgm2")) / 2;
    assert.ok(Math.abs(half - 1.959964 * at(row, "inertia_sd_kgm2")) < 2e-4 * half + 2e-6);
  }
} finally {
  rmSync(folder, { recursive: true });
}
