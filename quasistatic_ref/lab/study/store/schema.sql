-- The store of a study. Its tables are typed and refer to each other, so that what they hold is a
-- study's, or is refused; references are checked at the end of a transaction.
PRAGMA foreign_keys = ON;

CREATE TABLE study (
  kind TEXT NOT NULL CHECK (kind = 'solvers'),
  time_limit REAL NOT NULL CHECK (time_limit > 0), -- of a problem [s]
  facts TEXT NOT NULL CHECK (json_valid(facts))  -- the rest of the study file, and its problems
) STRICT;

CREATE TABLE machines (                          -- '' where results were not merged
  name TEXT PRIMARY KEY CHECK (length(name) <= 1000),
  facts TEXT NOT NULL CHECK (json_type(facts) = 'object'),
  versions TEXT NOT NULL CHECK (json_type(versions) = 'object')
) STRICT;

CREATE TABLE settings (
  name TEXT PRIMARY KEY CHECK (length(name) <= 1000),
  accuracy REAL CHECK (accuracy > 0 AND accuracy < 1e300), -- null: the solver's own
  promised REAL CHECK (abs(promised) < 1e300),             -- digits; null: what each solver promises
  tuned INTEGER NOT NULL CHECK (tuned IN (0, 1))
) STRICT;

CREATE TABLE solvers (
  interface TEXT NOT NULL CHECK (length(interface) <= 1000),
  name TEXT NOT NULL CHECK (length(name) <= 1000),
  target TEXT NOT NULL CHECK (json_valid(target)),
  present INTEGER NOT NULL CHECK (present IN (0, 1)),      -- 0: no longer in the study file
  PRIMARY KEY (interface, name)
) STRICT;

CREATE TABLE options (
  interface TEXT NOT NULL,
  solver TEXT NOT NULL,
  setting TEXT NOT NULL REFERENCES settings DEFERRABLE INITIALLY DEFERRED,
  options TEXT NOT NULL CHECK (json_type(options) = 'object'),
  promise TEXT NOT NULL CHECK (json_type(promise) = 'object'), -- of residuals, or digits, by an "optimal"
  PRIMARY KEY (interface, solver, setting),
  FOREIGN KEY (interface, solver) REFERENCES solvers DEFERRABLE INITIALLY DEFERRED
) STRICT;

CREATE TABLE problems (
  id TEXT NOT NULL UNIQUE CHECK (length(id) <= 1000),
  family TEXT NOT NULL CHECK (length(family) <= 1000),
  contacts INTEGER NOT NULL CHECK (contacts >= 0),
  mass_ratio REAL,
  h REAL,                                        -- time step [s]
  k INTEGER NOT NULL CHECK (k >= 0),
  n INTEGER NOT NULL CHECK (n >= 0),
  m INTEGER NOT NULL CHECK (m >= 0),
  condition REAL,                                -- of H, in SI units and in natural ones
  condition_natural REAL,
  kind TEXT NOT NULL CHECK (kind IN ('exact', 'enclosed', 'bounded', 'infeasible')),
  bound REAL NOT NULL CHECK (bound >= 0 AND bound < 1e300), -- of the answer's relative error
  sequence TEXT,                                 -- steps in order, and the place among them
  place INTEGER CHECK (place >= 0),
  PRIMARY KEY (id, family)
) STRICT;

CREATE TABLE rows (                              -- one measurement each
  problem TEXT NOT NULL,
  interface TEXT NOT NULL,
  solver TEXT NOT NULL,
  setting TEXT NOT NULL,
  mode TEXT NOT NULL,                            -- what is kept from step to step; '': no sequence
  warm INTEGER NOT NULL CHECK (warm IN (0, 1)),
  units TEXT NOT NULL CHECK (units IN ('raw', 'natural')),
  repetition INTEGER NOT NULL CHECK (repetition >= 0),
  machine TEXT NOT NULL REFERENCES machines DEFERRABLE INITIALLY DEFERRED,
  family TEXT NOT NULL,
  outcome TEXT NOT NULL CHECK (outcome IN ('solved', 'failed', 'crashed', 'timeout', 'memory', 'nan',
                                           'wrong_shape', 'not_run_budget')),
  claimed TEXT NOT NULL CHECK (length(claimed) <= 1000),
  feasible INTEGER NOT NULL CHECK (feasible IN (0, 1)),
  said_optimal INTEGER NOT NULL CHECK (said_optimal IN (0, 1)),
  said_infeasible INTEGER NOT NULL CHECK (said_infeasible IN (0, 1)),
  wrong INTEGER NOT NULL CHECK (wrong IN (0, 1)),
  wrong_multipliers INTEGER NOT NULL CHECK (wrong_multipliers IN (0, 1)),
  digits_delta_q REAL CHECK (abs(digits_delta_q) < 1e300),
  digits_net_wrench REAL CHECK (abs(digits_net_wrench) < 1e300),
  digits_multipliers REAL CHECK (abs(digits_multipliers) < 1e300),
  residuals_primal REAL,
  residuals_dual REAL,
  residuals_gap REAL,
  allowed_primal REAL,                           -- by the promise; null: it says nothing of them
  allowed_dual REAL,
  allowed_gap REAL,
  seconds_solver REAL CHECK (seconds_solver >= 0),
  seconds_setup REAL CHECK (seconds_setup >= 0),
  seconds_call REAL CHECK (seconds_call >= 0),
  seconds_low REAL CHECK (seconds_low >= 0),
  seconds_high REAL CHECK (seconds_high >= 0),
  seconds_first REAL CHECK (seconds_first >= 0),
  seconds_warm_up REAL CHECK (seconds_warm_up >= 0),
  seconds_start REAL CHECK (seconds_start >= 0),
  seconds_spent REAL NOT NULL CHECK (seconds_spent >= 0),
  calls INTEGER NOT NULL CHECK (calls >= 0),
  clock_agrees INTEGER CHECK (clock_agrees IN (0, 1)),
  memory INTEGER CHECK (memory >= 0),
  iterations INTEGER,
  repeats INTEGER CHECK (repeats IN (0, 1)),     -- the last answer again, or that to the step before
  PRIMARY KEY (problem, solver, interface, setting, mode, warm, units, repetition, machine),
  FOREIGN KEY (problem, family) REFERENCES problems DEFERRABLE INITIALLY DEFERRED,
  FOREIGN KEY (interface, solver, setting) REFERENCES options DEFERRABLE INITIALLY DEFERRED
) STRICT, WITHOUT ROWID;

CREATE TABLE unreached (solver TEXT PRIMARY KEY, reason TEXT NOT NULL) STRICT;
