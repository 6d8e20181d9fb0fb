"""Parts of HTML pages that need nothing beside them: the style, texts with indices, figures as data."""
