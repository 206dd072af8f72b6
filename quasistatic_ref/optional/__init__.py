"""Parts that make the core quicker or let it do more; each is a folder that can be deleted."""
