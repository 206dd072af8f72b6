"""Reference vectors: inputs of every layer of the model, each with its answer to the last bit."""
