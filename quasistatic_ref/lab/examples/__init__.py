"""Examples: each a module with a ``main()`` that returns numbers and a ``figure()``.

``quasistatic-ref figures door --numbers`` prints the numbers and writes the figure. The numbers
are asserted on in tests/lab/examples, the figures are the gallery of the docs, and the modules are
made into notebooks by ``python -m validation.tools.notebooks``.
"""
