-- The plots' data from the merged tables of both sweeps:
--     sqlite3 < tables.sql
-- reads cost.sqlite and error.sqlite, writes error.csv, fps.csv and bytes.csv.
.bail on
.mode csv
.separator , "\n"
.headers on
ATTACH 'file:cost.sqlite?mode=ro' AS cost;
ATTACH 'file:error.sqlite?mode=ro' AS error;

-- Steps of subdivision that a scheme takes of this cage first: a face's edge becomes 2^steps edges,
-- of `tess` segments each. And the rules whose limit surface it draws.
CREATE TEMP TABLE schemes (scheme TEXT PRIMARY KEY, steps INTEGER, rules TEXT);
INSERT INTO schemes VALUES
  ('gregory-stencil', 0, 'Catmull-Clark'), ('gregory-two-stage', 0, 'Catmull-Clark'),
  ('acc', 0, 'Catmull-Clark'), ('pm', 0, 'Catmull-Clark'), ('stam', 1, 'Catmull-Clark'),
  ('biseptic', 1, 'Catmull-Clark'), ('bolz', 1, 'Catmull-Clark'),
  ('tables-catmull-clark', 1, 'Catmull-Clark'), ('tables-loop', 1, 'Loop'),
  ('tables-butterfly', 2, 'Butterfly'), ('qas', 0, 'Loop'), ('pn-triangles', 0, 'Loop'),
  ('phong', 0, 'Loop'), ('flat', 0, 'Loop');
CREATE TEMP VIEW cases AS
  SELECT c.*, s.rules, c.tess << s.steps AS segments
  FROM cost.cases AS c JOIN schemes AS s USING (scheme) WHERE c.status = 'done';

-- Error against cost, at 16 segments on an edge of a face of the cage.
.once error.csv
SELECT scheme, rules,
  printf('%.4g', 1e6 * min(seconds) FILTER (WHERE gpu = 'radeon5870')) AS radeon5870_microseconds,
  printf('%.4g', 1e6 * min(seconds) FILTER (WHERE gpu = 'gtx480')) AS gtx480_microseconds,
  printf('%.4g', e.position_closest_point_scheme_to_limit_rms_diagonals) AS position_rms_diagonals,
  printf('%.4g', e.normal_closest_point_scheme_to_limit_rms_radians) AS normal_rms_radians
FROM cases JOIN error.cases AS e USING (model, scheme)
WHERE segments = 16 GROUP BY scheme ORDER BY min(seconds);

-- Frames a second against segments.
.once fps.csv
SELECT gpu, scheme, segments, printf('%.4g', 1 / seconds) AS frames_per_second
FROM cases WHERE segments <= 64 ORDER BY gpu, scheme, segments;

-- Bytes that stages fetch, at 16 segments. They are the same on every GPU.
.once bytes.csv
SELECT scheme,
  coalesce(compute_shader_fetched_bytes, 0) AS compute_shader_bytes,
  coalesce(vertex_shader_fetched_bytes, 0) AS vertex_shader_bytes,
  coalesce(hull_shader_fetched_bytes, 0) AS hull_shader_bytes,
  coalesce(domain_shader_fetched_bytes, 0) AS domain_shader_bytes,
  coalesce(pixel_shader_fetched_bytes, 0) AS pixel_shader_bytes
FROM cases WHERE segments = 16 AND gpu = 'gtx480'
ORDER BY compute_shader_bytes + vertex_shader_bytes + hull_shader_bytes + domain_shader_bytes
  + pixel_shader_bytes, scheme;
