// Made of web/protocol/messages.json by script/protocol. Do not edit.

/** The present. Binary: Float64, little endian, in this order; the header, then each section as often as its count says. Latest wins: frames that a slow client missed are not sent again. */
export const FRAME = {
  header: [
    "time_s",
    "now_s", // Live: where the run is; later than time_s while its past is looked at. Else the same.
    "real_time_factor", // Simulated over wall-clock time, of late; 0 while paused.
    "speed", // As asked for; 0: as fast as it can.
    "paused", // 1 or 0
    "driver", // Client, or 0
    "kinetic_j", // Energies; NaN where they are not known.
    "gravity_j",
    "elastic_j",
    "run", // Rises at every restart: what was plotted before is of another run.
    "body_count",
    "cable_count",
    "contact_count", // NaN forces where only the count is known: then `contacts` is empty.
    "contact_rows", // Entries of the section `contacts`.
    "push_count", // Pushes and drags that act.
    "value_count", // Channels of a program's own: Scene.values.
    "ghost_count", // Bodies of all ghosts: the same in every frame of a scene.
    "bend_count", // Of cables that lie against what they come to: the middles of their arcs, along each cable. Of ghosts the cables are behind those of the scene, in their order; -1: of none.
    "span_count", // Of cables with friction, along each: those between its places with friction, or between its bends. -1: of none.
  ],
  sections: [
    { name: "bodies", count: "body_count", fields: ["x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"] },
    { name: "cables", count: "cable_count", fields: ["tension_n", "length_m", "rest_length_m", "setpoint_n"] },
    { name: "contacts", count: "contact_rows", fields: ["x_m", "y_m", "z_m", "force_x_n", "force_y_n", "force_z_n"] },
    { name: "pushes", count: "push_count", fields: ["node", "force_x_n", "force_y_n", "force_z_n"] },
    { name: "values", count: "value_count", fields: ["value"] },
    { name: "ghosts", count: "ghost_count", fields: ["x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"] },
    { name: "bends", count: "bend_count", fields: ["cable", "x_m", "y_m", "z_m"] },
    { name: "spans", count: "span_count", fields: ["cable", "tension_n"] },
  ],
} as const;

/** Numbers of one entry of a section. */
export const VALUES = { bodies: 7, cables: 4, contacts: 6, pushes: 4, values: 1, ghosts: 7, bends: 4, spans: 2 } as const;
