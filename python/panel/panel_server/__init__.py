"""The operator's panel: what runs in loops goes to browsers, what operators ask goes to loops. See docs/panel.md."""
