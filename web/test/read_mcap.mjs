// Reads an .mcap file with @mcap/core and prints it as JSON: by its index, and sequentially with all
// checksums verified.
//
//   node read_mcap.mjs FILE [FROM_NS TO_NS]
import { open } from "node:fs/promises";
import { readFileSync } from "node:fs";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";

const [path, from, to] = process.argv.slice(2);
const file = await open(path);
const readable = {
  size: async () => BigInt((await file.stat()).size),
  read: async (offset, length) => {
    const bytes = new Uint8Array(Number(length));
    const { bytesRead } = await file.read(bytes, 0, Number(length), Number(offset));
    if (bytesRead !== Number(length)) throw new Error(`only ${bytesRead} of ${length} bytes at ${offset}`);
    return bytes;
  },
};
const reader = await McapIndexedReader.Initialize({ readable });
const text = new TextDecoder();
const channels = [...reader.channelsById.values()].map((channel) => {
  const schema = reader.schemasById.get(channel.schemaId);
  return {
    topic: channel.topic, encoding: channel.messageEncoding,
    schema: schema.name, schema_encoding: schema.encoding, json_schema: JSON.parse(text.decode(schema.data)),
  };
});
const message = ({ channelId, sequence, logTime, publishTime, data }, channelOf) => ({
  topic: channelOf(channelId).topic, sequence, log_time: String(logTime), publish_time: String(publishTime),
  data: JSON.parse(text.decode(data)),
});
const range = from === undefined ? {} : { startTime: BigInt(from), endTime: BigInt(to) };
const indexed = [];
for await (const one of reader.readMessages({ ...range, validateCrcs: true })) {
  indexed.push(message(one, (id) => reader.channelsById.get(id)));
}
const metadata = [];
for await (const record of reader.readMetadata()) metadata.push({ name: record.name, ...Object.fromEntries(record.metadata) });

const stream = new McapStreamReader({ validateCrcs: true, noMagicPrefix: false });
stream.append(readFileSync(path));
const known = new Map();
const streamed = [];
const records = {};
const offsets = [];
let dataCrc = 0;
for (let record; (record = stream.nextRecord()); ) {
  records[record.type] = (records[record.type] ?? 0) + 1;
  if (record.type === "Channel") known.set(record.id, record);
  if (record.type === "SummaryOffset") offsets.push([record.groupOpcode, record.groupStart, record.groupLength]);
  if (record.type === "DataEnd") dataCrc = record.dataSectionCrc;
  if (record.type === "Message") streamed.push(message(record, (id) => known.get(id)));
}
const { statistics, header, footer, chunkIndexes } = reader;
console.log(JSON.stringify({
  channels, indexed, streamed, metadata, records, header, footer, statistics, data_crc: dataCrc, offsets, done: stream.done(),
  chunks: chunkIndexes.map(({ messageStartTime, messageEndTime, compression }) => ({ messageStartTime, messageEndTime, compression })),
}, (_, value) => (typeof value === "bigint" ? String(value) : value instanceof Map ? Object.fromEntries(value) : value)));
await file.close();
