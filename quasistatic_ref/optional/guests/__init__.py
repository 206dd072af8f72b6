"""States of other simulators as steps."""
