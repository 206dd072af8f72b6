"""Reference vectors: inputs of every layer of the model, each with its answer to the last bit.

They judge programs of others, and the package as one of them. Its own steps are proved without
them, by ``certify``. Each file of ``layers/`` states the tolerances of its fields, with a reason.
"""
