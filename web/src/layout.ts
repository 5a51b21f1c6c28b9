// Generated from web/protocol/messages.json by script/protocol. Do not edit.

/** State at one time. Binary: Float64, little endian, in this order: the header, then each section as many times as its count in the header. A slow client receives only the newest frame. */
export const FRAME = {
  header: [
    "time_s",
    "now_s", // Live: present time of the run; later than time_s while a past time is displayed. Otherwise equal to time_s.
    "real_time_factor", // Recent ratio of simulated to wall-clock time; 0 while paused.
    "speed", // Requested speed; 0: as fast as possible.
    "paused", // 1: paused; 0: running.
    "driver", // Number of the driving client; 0: none.
    "kinetic_j", // Energies; NaN: unknown.
    "gravity_j",
    "elastic_j",
    "run", // Increases at every restart: earlier data belong to another run.
    "body_count",
    "cable_count",
    "contact_count", // Number of contacts; may be known although `contacts` is empty.
    "contact_rows", // Entries of the section `contacts`.
    "push_count", // Active pushes and drags.
    "value_count", // Channels of a user's program: Scene.values.
    "ghost_count", // Bodies of all ghosts; constant for a scene.
    "bend_count", // Bends of wrapped cables, in order along each cable: midpoints of their arcs. Cables of ghosts are numbered after those of the scene; -1: no bend.
    "span_count", // Spans of cables with friction, in order along each cable, between points with friction or bends. -1: no span.
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
